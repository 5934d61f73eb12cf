#!/usr/bin/env python3
"""First conjugate points: polhode beside other integrators, on the same starts, at equal achieved error, on one core.

    pip install heyoka scipy numba          (heyoka 7.13, scipy 1.17, numba 0.68 were used)
    python3 benches/peers/conjugate.py
    python3 benches/peers/conjugate.py --only polhode,heyoka --save measured.json --core 1

Problems SA and SPIN, 200 starts each, and references of 30 digits: see reference.py beside this file. What is compared is the time per
first conjugate time at the error that was achieved, never at the tolerance that was asked for: for a target error, each tool takes its
fastest setting whose largest error over the starts is at most the target, or, where none is (marked *), the fastest within a factor of
two of its smallest error. (--by median takes the median error instead.)

Every peer is given the best form known to us, and the benefit of the doubt:
  heyoka     Taylor's method, compiled just in time; one at a time with a terminal event, and 8 at a time with an event that is recorded. A
             batch stops when its first member does, so 8 at a time are told beforehand to stop at 1.001 times the conjugate time, which nobody
             knows. SPIN: lift, nine equations. SA: sin 2y, cos 2y as states with one column, and Euler's equations with the scalar Jacobi
             equation. With and without fast_math; compact mode is slower and left out. That J vanishes at t = 0 is harmless: only
             falls through zero are events. States are prepared beforehand; the calls from Python are in the time, and said.
  scipy      solve_ivp, DOP853, right-hand side and event compiled by numba. The least rtol that it accepts is 2.3e-14.
  Rust       ode_solvers (DOP853), numeris (Verner 9(8)), differential-equations (DOP853, its event): see rust/. Built here, with lto.
polhode: `cargo bench --bench conjugate_points -- --json`, by the bench profile. Its closed forms compute the point as well as the time.

Times are the fastest of several passes, after one that warms up (in Rust block by block of the starts, in Python by the time of the
process, so that a busy machine disturbs little); all processes are pinned to one core. What is not
installed is left out, and said. Nothing is written unless --save is given.
"""

import argparse
import json
import math
import os
import platform
import subprocess
import sys
import time
import warnings
from pathlib import Path

HERE = Path(__file__).resolve().parent
REFERENCE = json.loads((HERE / "reference.json").read_text())
SA, SPIN = REFERENCE["SA"], REFERENCE["SPIN"]
TARGETS = (1e-9, 1e-12, 1e-15)


def errors(problem, found):
    """Largest and median relative error, and how many starts have no answer."""
    pairs = list(zip(found, REFERENCE[problem]["starts"]))
    good = sorted(
        abs((t - start["t1_near"]) - start["t1_rest"]) / start["t1_near"]
        for t, start in pairs
        if t is not None and math.isfinite(t)
    )
    missing = len(pairs) - len(good)
    return (good[-1], good[len(good) // 2], missing) if good else (math.inf, math.inf, missing)


def row(tool, problem, asked, microseconds, found):
    largest, median, missing = errors(problem, found)
    return {
        "tool": tool, "problem": problem, "asked": asked, "microseconds": microseconds,
        "error_max": math.inf if missing else largest, "error_median": median, "failures": missing,
    }


def fastest(work, seconds=0.5, least=3):
    """Seconds of the fastest pass, in time of this process: a pass is longer than the system's time slices."""
    work()
    best, begun, passes = math.inf, time.perf_counter(), 0
    while passes < least or time.perf_counter() - begun < seconds:
        start = time.process_time()
        work()
        best = min(best, time.process_time() - start)
        passes += 1
    return best


# --- the equations ------------------------------------------------------------------------------------------------------------------


def serret_andoyer_angles(start):
    """State [p_y, sin 2y, cos 2y, dy, dp_y] and parameters [p_x^2, p_x dp_x]."""
    y0, p_x, p_y = start["y0"], start["p_x"], start["p_y"]
    a, b, c = SA["A"], SA["B"], SA["C"]
    z = (a + b) / 2 + (b - a) / 2 * math.cos(2 * y0)
    return [p_y, math.sin(2 * y0), math.cos(2 * y0), 0.0, p_x * z], [p_x * p_x, -p_x * p_y * (c - z)]


def serret_andoyer_euler(start):
    """State [M1, M2, M3 (scaled), J, J'] and parameters of 1/Z and of -2h G."""
    y0, p_x, p_y = start["y0"], start["p_x"], start["p_y"]
    a, b, c = SA["A"], SA["B"], SA["C"]
    sine, cosine = math.sin(y0), math.cos(y0)
    across = math.sqrt((p_x - p_y) * (p_x + p_y))
    two_h = across**2 * (a * sine**2 + b * cosine**2) + c * p_y**2
    scale = [math.sqrt((c - a) * (b - a)), math.sqrt((c - b) * (b - a)), math.sqrt((c - a) * (c - b))]
    state = [scale[0] * across * sine, scale[1] * across * cosine, scale[2] * p_y, 0.0, 1.0]
    square = scale[2] ** 2
    curvature = [-two_h * (a + b + c), 2 * two_h * (a * b + b * c + c * a) / c, -3 * two_h * a * b / c]
    return state, [square * p_x**2, square * two_h / c, *curvature]


def serret_andoyer_pendulum(start):
    """State [z = y', sin 2y, cos 2y, dy, dz] and parameters [alpha, beta, d alpha, d beta]: polhode's own equations."""
    y0, p_x, p_y = start["y0"], start["p_x"], start["p_y"]
    a, b, c = SA["A"], SA["B"], SA["C"]
    sine, cosine = math.sin(y0), math.cos(y0)
    mass = (c - b) + (b - a) * sine**2
    z, x_rate = p_y * mass, p_x * (a + (b - a) * cosine**2)
    alpha = (b - a) / 2 * (p_x**2 * (b - a) * cosine**2 + p_y * z + p_x**2 * (c - b))
    common = -(b - a) * p_x * z
    parameters = [alpha, -((b - a) ** 2) * p_x**2 / 2, common * ((c - b) - a), -common * (b - a)]
    return [z, math.sin(2 * y0), math.cos(2 * y0), 0.0, mass * x_rate], parameters


def spin_pendulum(start):
    """State [v, sin 2 beta, cos 2 beta, r2, r2', d beta, d beta', W] and parameter [g]: polhode's own equations."""
    k, b = SPIN["k"], start["p_theta"] / (2 * SPIN["k"])
    return [b, 0.0, 1.0, 0.0, 1.0, 0.0, 1 / (2 * k), 0.0], [1 / k**2 + b**2]


def spin_lift(start):
    """State [r, h, dh]."""
    return [1.0, 0.0, 0.0, 0.0, -start["p_theta"], 2.0, 0.0, -1.0, 0.0], []


# --- heyoka -------------------------------------------------------------------------------------------------------------------------


def heyoka_systems(hy):
    half, offset = (SA["B"] - SA["A"]) / 2, SA["C"] - (SA["A"] + SA["B"]) / 2
    p, s, c, dy, dp = hy.make_vars("p", "s", "c", "dy", "dp")
    width, q = offset - half * c, hy.par[0] - p * p
    rate = p * width
    angles = [
        (p, half * (q * s)), (s, 2.0 * (c * rate)), (c, -2.0 * (s * rate)),
        (dy, width * dp + 2 * half * ((p * s) * dy)), (dp, 2 * half * (hy.par[1] * s - (p * dp) * s + (q * c) * dy)),
    ]
    m1, m2, m3, j, jp = hy.make_vars("m1", "m2", "m3", "j", "jp")
    square = m3 * m3
    inverse = (hy.par[0] - square) / (hy.par[1] - square)
    euler = [
        (m1, m2 * m3), (m2, -(m1 * m3)), (m3, m1 * m2), (j, jp),
        (jp, (hy.par[2] + inverse * (hy.par[3] + hy.par[4] * inverse)) * j),
    ]
    first, third = 0.5 / SPIN["k"] ** 2, 0.5
    r1, r2, r3, h1, h2, h3, d1, d2, d3 = hy.make_vars("r1", "r2", "r3", "h1", "h2", "h3", "d1", "d2", "d3")
    lift = [
        (r1, -third * (h3 * r2)), (r2, third * (h3 * r1) - first * (h1 * r3)), (r3, first * (h1 * r2)),
        (h1, -third * (h3 * h2)), (h2, (third - first) * (h1 * h3)), (h3, first * (h1 * h2)),
        (d1, -third * (d3 * h2 + h3 * d2)), (d2, (third - first) * (d1 * h3 + h1 * d3)), (d3, first * (d1 * h2 + h1 * d2)),
    ]
    z, u, dz = hy.make_vars("z", "u", "dz")
    su = s * u
    pendulum = [
        (z, hy.par[0] * s + hy.par[1] * su), (s, 2.0 * (u * z)), (u, -2.0 * (s * z)), (dy, dz),
        (dz, hy.par[2] * s + hy.par[3] * su + (2 * hy.par[0] * u + 2 * hy.par[1] * (2 * (u * u) - 1.0)) * dy),
    ]
    w2 = (SPIN["k"] - 1) * (SPIN["k"] + 1) / SPIN["k"] ** 2
    v, rho, db, dv, w = hy.make_vars("v", "rho", "db", "dv", "w")
    beside = [
        (v, -w2 / 2 * s), (s, 2.0 * (u * v)), (u, -2.0 * (s * v)), (r2, rho), (rho, -(hy.par[0] * r2 + w2 * (u * r2))),
        (db, dv), (dv, -w2 * (u * db)), (w, -hy.par[0] * (db * r2)),
    ]
    return [
        ("SA", "pendulum", pendulum, dy, serret_andoyer_pendulum),
        ("SPIN", "pendulum", beside, -w, spin_pendulum),
        ("SA", "angles", angles, dy, serret_andoyer_angles),
        ("SA", "Euler", euler, j, serret_andoyer_euler),
        ("SPIN", "lift", lift, -(r1 * d1 + r2 * d2 + r3 * d3), spin_lift),
    ]


def heyoka_rows():
    import heyoka as hy
    import numpy as np

    hy.set_logger_level_critical()
    falling = hy.event_direction.negative
    lanes = 8
    for problem, form, system, event, make in heyoka_systems(hy):
        starts = REFERENCE[problem]["starts"]
        count = len(starts)
        states, parameters = (np.array(x) for x in zip(*map(make, starts)))
        states_8 = np.ascontiguousarray(states.reshape(count // lanes, lanes, -1).transpose(0, 2, 1))
        parameters_8 = np.ascontiguousarray(parameters.reshape(count // lanes, lanes, -1).transpose(0, 2, 1))
        until = 1.001 * np.array([start["t1_near"] for start in starts]).reshape(-1, lanes)
        for asked in (1e-6, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 2.2e-16):
            for options, suffix in (({}, ""), ({"fast_math": True}, ", fast_math")):
                found = np.zeros(count)

                one = hy.taylor_adaptive(
                    system, list(states[0]), pars=list(parameters[0]), tol=asked,
                    t_events=[hy.t_event(event, direction=falling)], **options,
                )
                state, pars = one.state, one.pars

                def scalar():
                    for i in range(count):
                        one.time = 0.0
                        state[:] = states[i]
                        if len(pars):
                            pars[:] = parameters[i]
                        one.reset_cooldowns()
                        one.propagate_until(1e3)
                        found[i] = one.time

                seconds = fastest(scalar)
                yield row(f"heyoka scalar, {form}{suffix}", problem, asked, seconds * 1e6 / count, found)

                first = [0]

                def record(_, t, __, lane):
                    found[first[0] + lane] = t

                batch = hy.taylor_adaptive_batch(
                    system, states_8[0], pars=parameters_8[0], tol=asked,
                    nt_events=[hy.nt_event_batch(event, record, direction=falling)], **options,
                )
                state_8, pars_8 = batch.state, batch.pars

                def eight(limit=until):
                    for i in range(count // lanes):
                        batch.set_time(0.0)
                        state_8[:] = states_8[i]
                        if len(pars_8):
                            pars_8[:] = parameters_8[i]
                        first[0] = lanes * i
                        batch.propagate_until(limit[i])

                found[:] = math.nan
                seconds = fastest(eight)
                yield row(f"heyoka batch of 8, {form}{suffix}", problem, asked, seconds * 1e6 / count, found)
        nowhere = np.zeros_like(until)
        idle = fastest(lambda: eight(nowhere)) * 1e6 / count
        print(f"  heyoka, {problem}, {form}: {idle:.2f} us per point of the batch's time are calls from Python", file=sys.stderr)


# --- scipy --------------------------------------------------------------------------------------------------------------------------


def scipy_rows():
    import numba
    import numpy as np
    from scipy.integrate import solve_ivp

    half, offset = (SA["B"] - SA["A"]) / 2, SA["C"] - (SA["A"] + SA["B"]) / 2
    first, third = 0.5 / SPIN["k"] ** 2, 0.5

    @numba.njit
    def angles(t, y, pars):
        p, s, c, dy, dp = y
        width, q = offset - half * c, pars[0] - p * p
        out = np.empty(5)
        out[0], out[1], out[2] = half * q * s, 2.0 * c * p * width, -2.0 * s * p * width
        out[3] = width * dp + 2.0 * half * p * s * dy
        out[4] = 2.0 * half * ((pars[1] - p * dp) * s + q * c * dy)
        return out

    @numba.njit
    def lift(t, y, pars):
        r1, r2, r3, h1, h2, h3, d1, d2, d3 = y
        o1, o3, e1, e3 = first * h1, third * h3, first * d1, third * d3
        out = np.empty(9)
        out[0], out[1], out[2] = -o3 * r2, o3 * r1 - o1 * r3, o1 * r2
        out[3], out[4], out[5] = -o3 * h2, (third - first) * h1 * h3, o1 * h2
        out[6] = -(e3 * h2 + o3 * d2)
        out[7] = (third - first) * (d1 * h3 + h1 * d3)
        out[8] = e1 * h2 + o1 * d2
        return out

    # Armed after a time that is shorter than every conjugate time by far: J ~ t^3 is rounding before.
    @numba.njit
    def event_angles(t, y, pars):
        return y[3] if t > 1e-2 else 1.0

    @numba.njit
    def event_lift(t, y, pars):
        return -(y[0] * y[6] + y[1] * y[7] + y[2] * y[8]) if t > 1e-2 else 1.0

    for problem, rates, event, make in (("SA", angles, event_angles, serret_andoyer_angles), ("SPIN", lift, event_lift, spin_lift)):
        starts = [(np.array(state), np.array(pars)) for state, pars in map(make, REFERENCE[problem]["starts"])]

        # An attribute cannot be set on a compiled function: the event is wrapped.
        def watched(t, y, pars):
            return event(t, y, pars)

        watched.terminal, watched.direction = True, -1
        for asked in (1e-6, 1e-9, 1e-12, 2.3e-14):
            found = [None] * len(starts)

            def work():
                for i, (state, pars) in enumerate(starts):
                    end = solve_ivp(rates, (0.0, 1e3), state, method="DOP853", events=watched, args=(pars,), rtol=asked, atol=asked)
                    found[i] = end.t_events[0][0] if len(end.t_events[0]) else None

            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                seconds = fastest(work, seconds=1.0, least=2)
            yield row("scipy DOP853, numba", problem, asked, seconds * 1e6 / len(starts), found)


# --- Rust: peers and polhode ----------------------------------------------------------------------------------------------------------


def lines(command, folder):
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}:\n{done.stderr[-3000:]}")
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


RUST_PEERS = ["cargo", "run", "--quiet", "--release", "--locked", "--", str(HERE / "reference.json")]
POLHODE = ["cargo", "bench", "--bench", "conjugate_points"]


def rust_rows():
    for line in lines(RUST_PEERS, HERE / "rust"):
        yield row(line["tool"], line["problem"], line["asked"], line["microseconds"], line["t1"])


def polhode_rows():
    for line in lines([*POLHODE, "--", "--json"], HERE.parents[1]):
        if line["failures"]:
            line["error_max"] = math.inf
        yield line


# --- tables ---------------------------------------------------------------------------------------------------------------------------


def family(tool):
    return tool.removesuffix(", fast_math") if tool.startswith("heyoka") else tool


def best(rows, target, by):
    """The fastest row within the target, or the most accurate one; and whether the target was reached."""
    within = [r for r in rows if r[by] <= target]
    if within:
        return min(within, key=lambda r: r["microseconds"]), True
    # Within a factor of two of its best: rounding, not method.
    limit = 2 * min(r[by] for r in rows)
    return min((r for r in rows if r[by] <= limit), key=lambda r: r["microseconds"]), False


def print_rows(rows):
    print(f"{'problem':8}{'tool':50}{'asked':>9}{'error max':>11}{'median':>10}{'us per point':>14}")
    for r in rows:
        asked = "-" if r["asked"] is None else f"{r['asked']:.1e}"
        note = f"  ({r['failures']} starts without an answer)" if r["failures"] else ""
        print(f"{r['problem']:8}{r['tool']:50}{asked:>9}{r['error_max']:11.1e}{r['error_median']:10.1e}{r['microseconds']:14.3f}{note}")


def print_ratios(rows, by):
    for problem in ("SA", "SPIN"):
        tools = {}
        for r in (r for r in rows if r["problem"] == problem):
            tools.setdefault(family(r["tool"]), []).append(r)
        ours = [tool for tool in tools if tool.startswith("polhode")]
        peers = [tool for tool in tools if tool not in ours]
        for target in TARGETS:
            chosen = {tool: best(tools[tool], target, by) for tool in tools}

            def line(name, tool):
                r, reached = chosen[tool]
                asked = "" if r["asked"] is None else f"{r['asked']:.1e}"
                return f"  {name:50}{asked:>9}{r[by]:11.1e}{' ' if reached else '*'}{r['microseconds']:12.3f}"

            print(f"\n{problem}: the fastest with an achieved error ({by.removeprefix('error_')}) of {target:.0e}; * not reached")
            print(f"  {'':50}{'asked':>9}{'achieved':>11} {'us per point':>12}")
            for i, tool in enumerate(ours):
                print(line(f"[{i + 1}] {tool}", tool))
            heads = "".join(f"{f'/ [{i + 1}]':>9}" for i in range(len(ours)))
            print(f"  {'peers, and their time divided by polhode':83}{heads}")
            for tool in peers:
                times = (chosen[tool][0]["microseconds"] / chosen[own][0]["microseconds"] for own in ours)
                print(line(f"    {tool}", tool) + "".join(f"{time:9.2f}" if time < 10 else f"{time:9.1f}" for time in times))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="polhode,rust,heyoka,scipy", help="which tools, a comma between them; polhode is needed for ratios")
    parser.add_argument("--by", choices=("max", "median"), default="max", help="which error has to reach the target")
    parser.add_argument("--core", type=int, help="the core to be pinned to (the last one by default)")
    parser.add_argument("--save", type=Path, help="write all rows to this file, as JSON")
    arguments = parser.parse_args()
    wanted = arguments.only.split(",")
    # Built before pinning, on all cores.
    if "rust" in wanted:
        lines(["cargo", "build", "--quiet", "--release", "--locked"], HERE / "rust")
    if "polhode" in wanted:
        lines([*POLHODE, "--no-run"], HERE.parents[1])
    core = None
    if hasattr(os, "sched_setaffinity"):
        core = arguments.core if arguments.core is not None else max(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {core})
    rows = []
    sources = {"polhode": polhode_rows, "rust": rust_rows, "heyoka": heyoka_rows, "scipy": scipy_rows}
    for name, source in sources.items():
        if name not in wanted:
            continue
        print(f"{name} ...", file=sys.stderr)
        try:
            rows.extend(source())
        except ImportError as error:
            print(f"  left out: {error}", file=sys.stderr)
    rows.sort(key=lambda r: r["problem"])
    pinned = f"pinned to core {core}" if core is not None else "not pinned"
    print(f"{platform.machine()}, {os.cpu_count()} cores, {pinned}; references: {REFERENCE['origin']}\n")
    print_rows(rows)
    if any(r["tool"].startswith("polhode") for r in rows):
        print_ratios(rows, f"error_{arguments.by}")
    if arguments.save:
        arguments.save.write_text(json.dumps(rows, indent=1) + "\n")


if __name__ == "__main__":
    main()

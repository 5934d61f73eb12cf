#!/usr/bin/env python3
"""Reference values for benches/peers/conjugate.py: 200 first conjugate times of each problem, by two routes that share nothing.

    python3 benches/peers/reference.py            computes both routes, compares them, writes benches/peers/reference.json

Problems.
  SA    Serret-Andoyer metric, A, B, C = 1.5, 2, 2.8, energy 1/2, cos^2 y0 = 1/10, ascending, xi1 = 0.11 ... 0.99 (200 values).
  SPIN  almost-Riemannian metric of three spins, k = 0.8, start on the equator, H = 1, p_theta = 1e-3 ... 20 (200, geometric).

Every input is rounded to a binary64 number first and the reference is exact for these numbers, so nobody is charged for the rounding
of an input. A Serret-Andoyer start is given in two ways: by momenta (y0, p_x, p_y), which every integrator needs, and by (phi0, delta),
the distance to the separatrix, which a closed form can use. These are different numbers after rounding, with a reference of their own
each: p_x loses up to two digits near xi1 = 0.99 (condition number about 100), delta none.

First route, 50 digits: SA, the pole-free equation sn T + sn psi0 sn(T + psi0) [(1 - L) T - eps(T)] = 0 on (2K, 4K - psi0), from
eq. (15) by the addition theorems, with mpmath's Jacobi functions; SPIN, the monotone phase Theta = lambda - Arg(Bq + iA) = pi.
Second route, in fixed point with 200 bits: integration by power series of order 50 of the equations (9) with sin 2y, cos 2y as states and one Jacobi
column; of the lift to R^3 x so(3)* with one column. They must agree to 1e-32 (SA by momenta and SPIN; the (phi0, delta) starts are
turned into momenta with 50 digits and integrated as well).

Needs mpmath (pip install mpmath). Takes some ten minutes, nearly all of it in the first route.
"""

import json
import operator
import sys
from pathlib import Path

import mpmath
from mpmath import mp, mpf

# The tools read A, B, C and k as binary64 numbers: so do we.
A, B, C, K_SPIN = mpf(1.5), mpf(2), mpf(2.8), mpf(0.8)
COUNT = 200
ORDER = 50
AGREEMENT = mpf("1e-32")
DIGITS, BITS = 50, 200


# --- first route: closed forms ---------------------------------------------------------------------------------------------------


def jacobi_epsilon(t, m):
    """The integral of dn^2 from 0 to t, with sn t, cn t."""
    k = mpmath.ellipk(m)
    turns = mpmath.nint(t / (2 * k))
    rest = t - 2 * turns * k
    sn, cn, dn = (mpmath.ellipfun(name, rest, m=m) for name in ("sn", "cn", "dn"))
    integral = sn * mpmath.elliprf(cn**2, dn**2, 1) - m / 3 * sn**3 * mpmath.elliprd(cn**2, dn**2, 1)
    sign = -1 if int(turns) % 2 else 1
    return integral + 2 * turns * mpmath.ellipe(m), sign * sn, sign * cn


def serret_andoyer_closed(sine0, p_x, in_y, separatrix):
    """First conjugate time; sin(y0 - pi/2), p_x, p_y^2 (C - Z) > 0 ascending, and B p_x^2 - 2h."""
    equator = (B - A) * p_x**2 - separatrix
    minor = (C - B) * p_x**2 + separatrix
    speed = mpmath.sqrt((B - A) * minor)
    m = (C - B) * equator / ((B - A) * minor)
    one_minus_l = A * separatrix / (B * equator + A * separatrix)
    k = mpmath.ellipk(m)
    amplitude = mpmath.atan(sine0 * mpmath.sqrt((B - A) * minor / ((C - A) * in_y)))
    psi0 = k + mpmath.ellipf(amplitude, m)

    def equation(t):
        epsilon, sn, _ = jacobi_epsilon(t, m)
        sn0, sn_sum = mpmath.ellipfun("sn", psi0, m=m), mpmath.ellipfun("sn", t + psi0, m=m)
        return sn + sn0 * sn_sum * (one_minus_l * t - epsilon)

    low, high = 2 * k, 4 * k - psi0
    with mp.workdps(20):
        start = mpmath.findroot(equation, (low, high), solver="illinois", tol=mpf("1e-30"), maxsteps=200, verify=False)
    root = mpmath.findroot(equation, (start, start * (1 + mpf("1e-15"))), solver="secant", tol=mpf("1e-90"), verify=False)
    if not low <= root <= high:
        sys.exit(f"the root {root} left its bracket ({low}, {high})")
    return root / speed


def spin_closed(k, p):
    """First conjugate time for k < 1 and p > 0: the only zero of Theta - pi."""
    g, b, l2 = mpmath.sqrt(p**2 + 4), p / (2 * k), (1 - k) * (1 + k) / k**2
    c0 = mpmath.sqrt(b**2 + l2)
    m, mc = l2 / c0**2, b**2 / c0**2
    characteristic = 1 - k**2 * mc
    complete_k = mpmath.ellipk(m)
    complete_pi = mpmath.ellippi(characteristic, m)

    def phase(t):
        u = c0 * t
        epsilon, sn, cn = jacobi_epsilon(u, m)
        turns = mpmath.nint(u / (2 * complete_k))
        sign = -1 if int(turns) % 2 else 1
        s, c, d = sign * sn, sign * cn, mpmath.sqrt(mc + m * cn**2)
        x = c**2
        f = s * mpmath.elliprf(x, d**2, 1)
        pi = f + characteristic / 3 * s**3 * mpmath.elliprj(x, d**2, 1, x + (1 - characteristic) * s**2)
        pi += 2 * turns * complete_pi
        lam = (2 / g) * (t + p**2 / (4 * c0) * pi)
        a = g * epsilon / (k * c0 * d)
        bq = (2 * k / d) * (d**2 + l2 * cn**2 + (1 + c0**2) * m * epsilon * sn * cn / d)
        return lam - mpmath.atan2(a, bq) - mpmath.pi  # A > 0 for t > 0: the argument is in (0, pi)

    # lambda(t1) is in (pi, 2 pi) and its rate at least G/2: a bracket.
    low, high = mpf(0), 4 * mpmath.pi / g / min(1, k**2)
    with mp.workdps(20):
        start = mpmath.findroot(phase, (low + mpf("1e-6"), high), solver="illinois", tol=mpf("1e-30"), maxsteps=200, verify=False)
    return mpmath.findroot(phase, (start, start * (1 + mpf("1e-15"))), solver="secant", tol=mpf("1e-90"), verify=False)


# --- second route: power series of the equations of motion ----------------------------------------------------------------------


def fixed(x):
    return int(mpmath.nint(mpmath.ldexp(x, BITS)))


def cauchy(a, b, n):
    return sum(map(operator.mul, a[: n + 1], b[n::-1])) >> BITS


def at(series, t):
    value = 0
    for coefficient in reversed(series):
        value = (value * t >> BITS) + coefficient
    return value


def first_zero(initial, coefficients, scalar):
    """Integrates in fixed point with BITS bits until `scalar` falls through zero, and finds the zero by bisection."""
    state, time, first = [fixed(x) for x in initial], 0, True
    while True:
        series = [[x] for x in state]
        for n in range(ORDER):
            for one, rate in zip(series, coefficients(series, n)):
                one.append(rate // (n + 1))
        # A third of the radius of convergence, as the last two coefficients show it.
        sizes = [(mpf(max(abs(one[i]) for one in series)) / 2**BITS, i) for i in (ORDER - 1, ORDER)]
        length = fixed(min(size ** (-mpf(1) / i) for size, i in sizes) / 6)
        points = [length * i // 16 for i in range(1 if first else 0, 17)]
        values = [scalar([at(one, t) for one in series]) for t in points]
        for low, high, v_low, v_high in zip(points, points[1:], values, values[1:]):
            if v_low > 0 >= v_high:
                while high - low > 1 << (BITS - 120):
                    middle = (low + high) // 2
                    low, high = (middle, high) if scalar([at(one, middle) for one in series]) > 0 else (low, middle)
                return mpmath.ldexp(mpf(time + low), -BITS)
        state, time, first = [at(one, length) for one in series], time + length, False
        if time > 100 << BITS:
            sys.exit("no zero found")


def serret_andoyer_integrated(y0, p_x, p_y):
    """Equations (9) with sin 2y and cos 2y as states: p_y, sin 2y, cos 2y, and the column dy, dp_y with p_x dx + p_y dy = 0."""
    half = fixed((B - A) / 2)
    offset, p_x_squared = fixed(C - (A + B) / 2), fixed(p_x**2)
    z0 = A * mpmath.sin(y0) ** 2 + B * mpmath.cos(y0) ** 2
    px_dpx = fixed(-p_x * p_y * (C - z0))
    times = lambda a, b: a * b >> BITS

    def rates(series, n):
        p, s, c, dy, dp = series
        width = [-times(half, x) for x in c]  # C - Z
        width[0] += offset
        if n == 0:
            y_rate.clear(), q.clear(), p_dp.clear(), p_s.clear(), q_dy.clear()
        y_rate.append(cauchy(p, width, n))
        q.append((p_x_squared if n == 0 else 0) - cauchy(p, p, n))
        p_dp.append(cauchy(p, dp, n))
        p_s.append(cauchy(p, s, n))
        q_dy.append(cauchy(q, dy, n))
        return [
            times(half, cauchy(q, s, n)),
            2 * cauchy(c, y_rate, n),
            -2 * cauchy(s, y_rate, n),
            cauchy(width, dp, n) + 2 * times(half, cauchy(p_s, dy, n)),
            2 * times(half, times(px_dpx, s[n]) - cauchy(p_dp, s, n) + cauchy(q_dy, c, n)),
        ]

    y_rate, q, p_dp, p_s, q_dy = [], [], [], [], []
    return first_zero([p_y, mpmath.sin(2 * y0), mpmath.cos(2 * y0), mpf(0), p_x * z0], rates, lambda x: x[3])


def spin_integrated(k, p):
    """The lift to R^3 x so(3)*: r, h, dh; the scalar -r.dh."""
    first, third = fixed(1 / (2 * k**2)), fixed(mpf(1) / 2)
    difference = third - first

    def rates(series, n):
        r1, r2, r3, h1, h2, h3, d1, d2, d3 = series
        times = lambda factor, *pairs: factor * sum(cauchy(a, b, n) for a, b in pairs) >> BITS
        return [
            -times(third, (h3, r2)),
            times(third, (h3, r1)) - times(first, (h1, r3)),
            times(first, (h1, r2)),
            -times(third, (h3, h2)),
            times(difference, (h1, h3)),
            times(first, (h1, h2)),
            -times(third, (d3, h2), (h3, d2)),
            times(difference, (d1, h3), (h1, d3)),
            times(first, (d1, h2), (h1, d2)),
        ]

    start = [1, 0, 0, 0, -p, 2, 0, -1, 0]
    return first_zero([mpf(x) for x in start], rates, lambda x: -(x[0] * x[6] + x[1] * x[7] + x[2] * x[8]))


# --- the starts -------------------------------------------------------------------------------------------------------------------


def rounded(x):
    return float(mpmath.nstr(x, 30))


def serret_andoyer_starts():
    y0 = mpmath.acos(mpmath.sqrt(mpf(1) / 10))
    alpha, parameter = mpmath.sqrt(C - A), (B - A) / (C - A)
    phi0 = rounded(mpmath.ellipf(y0 - mpmath.pi / 2, parameter) / alpha)
    for i in range(COUNT):
        xi1 = mpf(11) / 100 + mpf(88) / 100 * i / (COUNT - 1)
        p_x = 1 / mpmath.sqrt(A + (B - A) * xi1)
        z0 = A + (B - A) / 10
        p_y = mpmath.sqrt((1 - p_x**2 * z0) / (C - z0))
        yield {
            "xi1": rounded(xi1), "y0": rounded(y0), "p_x": rounded(p_x), "p_y": rounded(p_y),
            "phi0": phi0, "delta": rounded(B * p_x**2 - 1),
        }


def by_momenta(start):
    y0, p_x, p_y = (mpf(start[name]) for name in ("y0", "p_x", "p_y"))
    z0 = A * mpmath.sin(y0) ** 2 + B * mpmath.cos(y0) ** 2
    in_y = p_y**2 * (C - z0)
    return -mpmath.cos(y0), p_x, in_y, B * p_x**2 - (p_x**2 * z0 + in_y), (y0, p_x, p_y)


def by_delta(start):
    phi0, delta = mpf(start["phi0"]), mpf(start["delta"])
    alpha, parameter = mpmath.sqrt(C - A), (B - A) / (C - A)
    sine = mpmath.ellipfun("sn", alpha * phi0, m=parameter)
    p_x = mpmath.sqrt((1 + delta) / B)
    z0 = A + (B - A) * sine**2
    in_y = 1 - p_x**2 * z0
    momenta = (mpmath.pi / 2 + mpmath.asin(sine), p_x, mpmath.sqrt(in_y / (C - z0)))
    return sine, p_x, in_y, delta, momenta


def store(start, key, t1):
    """As digits, and as the nearest binary64 number and the rest, so that errors of 1e-20 can be computed in binary64."""
    near = float(t1)
    start.update({key: mpmath.nstr(t1, 30), f"{key}_near": near, f"{key}_rest": float(t1 - near)})
    return start


def agreed(name, closed, integrated):
    second = integrated()
    difference = abs(second / closed - 1)
    if difference > AGREEMENT:
        sys.exit(f"{name}: the routes differ by {mpmath.nstr(difference, 3)}: {closed}, {second}")
    return difference


def main():
    mp.dps = DIGITS
    worst = {"SA": mpf(0), "SPIN": mpf(0)}
    sa, spin = [], []
    for start in serret_andoyer_starts():
        for key, read in (("t1", by_momenta), ("t1_by_delta", by_delta)):
            *closed_inputs, momenta = read(start)
            t1 = serret_andoyer_closed(*closed_inputs)
            worst["SA"] = max(worst["SA"], agreed(start, t1, lambda: serret_andoyer_integrated(*momenta)))
            store(start, key, t1)
        sa.append(start)
    for i in range(COUNT):
        p = rounded(mpf(10) ** (-3 + (mpmath.log10(20) + 3) * i / (COUNT - 1)))
        t1 = spin_closed(K_SPIN, mpf(p))
        worst["SPIN"] = max(worst["SPIN"], agreed(p, t1, lambda: spin_integrated(K_SPIN, mpf(p))))
        spin.append(store({"p_theta": p}, "t1", t1))
    origin = (
        f"benches/peers/reference.py, mpmath {mpmath.__version__}: closed forms with {DIGITS} digits; power series of order {ORDER} with "
        f"{BITS} bits agree to {mpmath.nstr(worst['SA'], 2)} (SA) and {mpmath.nstr(worst['SPIN'], 2)} (SPIN), relative"
    )
    out = {
        "origin": origin,
        "SA": {"A": 1.5, "B": 2.0, "C": 2.8, "starts": sa},
        "SPIN": {"k": 0.8, "starts": spin},
    }
    text = json.dumps(out, indent=1).replace("\n    ", " ").replace("\n   }", " }")
    (Path(__file__).resolve().parent / "reference.json").write_text(text + "\n")
    print(origin)


if __name__ == "__main__":
    main()

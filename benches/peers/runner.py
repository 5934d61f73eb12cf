#!/usr/bin/env python3
"""Nothing to do: polhode beside ninja and make, on the same graph, in one script.

    cargo build --release && python3 benches/peers/runner.py
    python3 benches/peers/runner.py --nodes 1000 --repeat 31 --binary target/release/polhode
    python3 benches/peers/runner.py --configs experiments      the article's graph

A folder of configs is computed once by polhode; its graph (`polhode graph --json`) is then written as build.ninja and Makefile, with a
file for each node, the same edges, and for each exported file one more target, and built once. Then the three are run in turn with
nothing to do, as whole processes. What each does in that time differs: ninja and make compare time stamps; polhode reads its configs and
re-hashes every record, object and output; the graph and its keys it remembers, as long as program and configs are the same. Without --configs: copies of one fast experiment with different
numbers of starts, until there are as many nodes as asked for.

Needs make, and ninja (apt install ninja-build, or pip install ninja); one that is missing is left out, and said.
"""

import argparse
import json
import os
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parents[2]


def run(command, folder):
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with {done.returncode}:\n{done.stderr[-2000:]}")
    return done


def configs(folder, nodes, binary):
    text = (HERE / "experiments/remark_3_25.toml").read_text()
    (folder / "experiments").mkdir()
    for copy in range(max(1, nodes)):
        body = text.replace("count = 121", f"count = {11 + copy}").replace("0.4, 0.2", f"{0.4 + copy * 1e-6!r}, 0.2")
        # Another body, so that no two copies share a node.
        body = body.replace("A = 1.5", f"A = {1.5 - copy * 1e-5!r}")
        (folder / f"experiments/c{copy:04}.toml").write_text(body)
        if copy % 10 == 0 or copy * 9 >= nodes:
            graph = json.loads(run([binary, "graph", "--json"], folder).stdout)
            if len(graph["nodes"]) >= nodes:
                return


def write_peers(folder, graph):
    """The same graph for ninja and make: a text file a node, made of the files it reads; a copy for each exported file."""
    name = {}
    ninja = ["rule cat\n  command = cat $in /dev/null > $out\n", "rule cp\n  command = cp $in $out\n"]
    make, everything = ["all: exports\n"], []
    for number, node in enumerate(graph["nodes"]):
        name[node["address"]] = f"n/{number}"
    for node in graph["nodes"]:
        out = name[node["address"]]
        sources = sorted({name[source["from"]] for source in node["inputs"]}) or ["config"]
        ninja.append(f"build {out}: cat {' '.join(sources)}\n")
        make.append(f"{out}: {' '.join(sources)}\n\tcat $^ > $@\n")
    for number, export in enumerate(graph["exports"]):
        out = f"e/{number}"
        ninja.append(f"build {out}: cp {name[export['from']]}\n")
        make.append(f"{out}: {name[export['from']]}\n\tcp $< $@\n")
        everything.append(out)
    make.append(f"exports: {' '.join(everything)}\n.PHONY: all exports\n")
    for sub in ("n", "e"):
        (folder / sub).mkdir()
    (folder / "config").write_text("one line\n")
    (folder / "build.ninja").write_text("".join(ninja))
    (folder / "Makefile").write_text("".join(make))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--binary", default=str(HERE / "target/release/polhode"))
    arguments.add_argument("--nodes", type=int, default=1000)
    arguments.add_argument("--repeat", type=int, default=21)
    arguments.add_argument("--configs", help="a folder of configs, in place of copies of one experiment")
    options = arguments.parse_args()
    binary = os.path.abspath(options.binary)
    if not os.path.exists(binary):
        sys.exit(f"{binary} is not there: cargo build --release, or --binary FILE")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        (folder / "ours").mkdir()
        (folder / "peers").mkdir()
        if options.configs:
            shutil.copytree(options.configs, folder / "ours/experiments")
        else:
            configs(folder / "ours", options.nodes, binary)
        graph = json.loads(run([binary, "graph", "--json"], folder / "ours").stdout)
        began = time.perf_counter()
        run([binary, "figures", "--no-progress"], folder / "ours")
        first = time.perf_counter() - began
        write_peers(folder / "peers", graph)
        contestants = {"polhode": ([binary, "figures"], "ours"), "make": (["make", "-s"], "peers")}
        ninja = shutil.which("ninja")
        if ninja:
            contestants["ninja"] = ([ninja, "--quiet"], "peers")
        else:
            print("ninja is not here: left out")
        if not shutil.which("make"):
            print("make is not here: left out")
            del contestants["make"]
        times = {name: [] for name in contestants}
        for name, (command, sub) in contestants.items():
            run(command, folder / sub)
        for _ in range(options.repeat):
            for name, (command, sub) in contestants.items():
                began = time.perf_counter()
                done = run(command, folder / sub)
                times[name].append(time.perf_counter() - began)
                if name == "polhode" and " 0 ran," not in done.stderr:
                    sys.exit(f"there was something to do:\n{done.stderr}")
        size = sum(file.stat().st_size for part in (".polhode/v1/objects", ".polhode/v1/records", "figures")
                   for file in (folder / "ours" / part).rglob("*") if file.is_file())
        print(f"{len(graph['nodes'])} nodes, {len(graph['exports'])} files; polhode computed them in {first:.2f} s and re-hashes "
              f"{size / 1e6:.1f} MB each time")
        print(f"{platform.machine()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}; {options.repeat} runs each, in turn")
        print(f"{'':10}{'least':>10}{'median':>10}{'largest':>10}   of polhode's median")
        ours = statistics.median(times["polhode"])
        for name, all_times in times.items():
            middle = statistics.median(all_times)
            print(f"{name:10}{min(all_times) * 1e3:8.1f}ms{middle * 1e3:8.1f}ms{max(all_times) * 1e3:8.1f}ms   {middle / ours:.2f}")


if __name__ == "__main__":
    main()

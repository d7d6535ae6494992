"""The engine and a numba program in turn on the same workload, and the ratio of their medians.

python3 benches/peers/engine.py PYTHON PEER [--rounds N] [--threads N]
"""
import argparse
import json
import pathlib
import statistics
import subprocess

parser = argparse.ArgumentParser()
parser.add_argument("python", help="a Python with numpy and numba")
parser.add_argument("peer", help="the numba program")
parser.add_argument("--rounds", type=int, default=3)
parser.add_argument("--threads", type=int, default=2)
parser.add_argument("--cases", nargs="*", default=["2d1e6", "3d1e5"])
options = parser.parse_args()
engine = pathlib.Path("target/release/examples/throughput").resolve()
engine = str(engine)


def measure(command):
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["ns_per_pair"]


for case in options.cases:
    for extra in ([], ["--shuffle"]):
        arguments = [case, "--threads", str(options.threads), *extra]
        ours, theirs = [], []
        for _ in range(options.rounds):
            ours.append(measure([engine, *arguments]))
            theirs.append(measure([options.python, options.peer, *arguments]))
        ratio = statistics.median(theirs) / statistics.median(ours)
        print(
            f"{' '.join(arguments)}: engine {statistics.median(ours):.2f} ns, peer {statistics.median(theirs):.2f} ns "
            f"for each directed pair; ratio {ratio:.2f}",
            flush=True,
        )

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
parser.add_argument("--rounds", type=int, default=6)
parser.add_argument("--threads", type=int, default=2)
parser.add_argument("--cases", nargs="*", default=["2d1e6", "3d1e5"])
options = parser.parse_args()
engine = pathlib.Path("target/release/examples/throughput").resolve()
engine = str(engine)


def measure(command):
    """The times of all runs, in nanoseconds for each directed pair."""
    record = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return [seconds / record["directed_pairs"] * 1e9 for seconds in record["runs"]]


def summary(times):
    """The median, and the median of the fastest fifth: of the machine when nothing else has its share of it."""
    return statistics.median(times), statistics.median(sorted(times)[: max(1, len(times) // 5)])


for case in options.cases:
    for extra in ([], ["--shuffle"]):
        arguments = [case, "--threads", str(options.threads), "--runs", "5", *extra]
        ours, theirs = [], []
        for _ in range(options.rounds):
            ours += measure([engine, *arguments])
            theirs += measure([options.python, options.peer, *arguments])
        ours, theirs = summary(ours), summary(theirs)
        print(
            f"{case}{' shuffled' if extra else ''}, {options.threads} threads, ns for each directed pair: "
            f"engine {ours[0]:.1f} (fast fifth {ours[1]:.1f}), peer {theirs[0]:.1f} ({theirs[1]:.1f}); "
            f"ratio {theirs[0] / ours[0]:.2f} ({theirs[1] / ours[1]:.2f})",
            flush=True,
        )

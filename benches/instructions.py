"""Instructions of the engine for each directed pair, counted by callgrind, and its time beside them.

python3 benches/instructions.py [--case 2d1e4]

Two runs are counted, one of which goes once more over all particles: what differs is one pass, search included. Callgrind
does not know AVX-512, so the other two paths are counted.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

parser = argparse.ArgumentParser()
parser.add_argument("--case", default="2d1e4")
options = parser.parse_args()
engine = pathlib.Path("target/release/examples/throughput")
if not engine.exists():
    sys.exit(f"{engine} is not there: cargo build --release --example throughput")
if shutil.which("valgrind") is None:
    sys.exit("valgrind is not installed")


def command(path, runs):
    return [str(engine), options.case, "--threads", "1", "--path", path, "--runs", str(runs)]


def instructions(path, runs):
    valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    counted = subprocess.run([*valgrind, *command(path, runs)], check=True, capture_output=True, text=True)
    return int(re.search(r"Collected : (\d+)", counted.stderr)[1])


for path in ["avx2", "portable"]:
    record = json.loads(subprocess.run(command(path, 9), check=True, capture_output=True, text=True).stdout)
    one_pass = instructions(path, 2) - instructions(path, 1)
    print(
        f"{options.case}, {path}, one thread, for each directed pair: "
        f"{one_pass / record['directed_pairs']:.1f} instructions, {record['ns_per_pair']:.2f} ns",
        flush=True,
    )

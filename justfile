# What is there to do.
default:
    @just --list

# Run the tests.
test:
    cargo test

# Format, lints, docs, licences, spelling: everything quick that CI checks beside the tests.
check:
    bash .ci/run fmt clippy docs licences typos

# Build the API documentation.
doc:
    cargo doc --no-deps

# Run the benchmarks.
bench:
    cargo bench

# The certified 50-digit lattice sum, and the same by python-flint and mpmath beside it.
bench-sums:
    cargo bench --bench sums
    python3 -m venv target/peers
    target/peers/bin/pip install --quiet --requirement benches/peers/requirements.txt
    target/peers/bin/python benches/peers/lattice_sum.py

# The engine and the numba program PEER in turn on the same workload, and the ratio of their medians.
bench-peers PEER *OPTIONS:
    cargo build --release --example throughput
    python3 -m venv target/peers
    target/peers/bin/pip install --quiet numpy numba
    python3 benches/peers/engine.py target/peers/bin/python {{ PEER }} {{ OPTIONS }}

# Instructions of the engine for each directed pair (valgrind must be installed), and its time beside them.
bench-instructions *OPTIONS:
    cargo build --release --example throughput
    python3 benches/instructions.py {{ OPTIONS }}

# Regenerate the committed reports in place; with NAMES, only these, and new ones too.
reports *NAMES:
    bash .ci/reports write {{ NAMES }}

# The committed pages from the committed reports.
pages:
    cargo run --release -- report reports --html

# Everything that CI does.
ci:
    bash .ci/run

# Format the code.
fmt:
    cargo fmt

# Make the reference chapters of the book anew.
reference:
    cargo run --release -- reference docs/reference

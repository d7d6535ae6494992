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

# Regenerate the committed reports in place; with NAMES, only these, and new ones too.
reports *NAMES:
    bash .ci/reports write {{ NAMES }}

# Everything that CI does.
ci:
    bash .ci/run

# Format the code.
fmt:
    cargo fmt

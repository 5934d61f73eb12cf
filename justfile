# Recipes of the reproducible-paper pipeline; `just` lists them.

[private]
default:
    @just --list

# Regenerate every figure, table and value of the article into figures/ (only what is stale is computed).
[group('article')]
figures *ARGS:
    cargo run --quiet -- figures {{ARGS}}

# Goldens, references and claims: the verdict table.
[group('article')]
check *ARGS:
    cargo run --quiet -- check {{ARGS}}

# Why a figure, a table or an experiment will (not) be computed again.
[group('article')]
why TARGET:
    cargo run --quiet -- why {{TARGET}}

# All tests.
[group('develop')]
test *ARGS:
    cargo test {{ARGS}}

# The long tests: 500 kills on a small graph and 12 on the article's, ten minutes of mutated configs, one real rebuild.
[group('develop')]
long:
    POLHODE_KILLS=500 cargo test --test faults random_kills -- --include-ignored --nocapture --test-threads 1
    POLHODE_MUTATION_SECONDS=600 cargo test --test mutation -- --nocapture
    cargo test --test rebuild -- --ignored --nocapture

# Accept the numbers, verdicts and work of the present build as the golden ones; read the diff before committing it.
[group('develop')]
bless:
    INSTA_UPDATE=always INSTA_FORCE_PASS=1 cargo test --test golden
    git --no-pager diff --stat -- golden

# Benchmarks on this machine.
[group('develop')]
bench *ARGS:
    cargo bench {{ARGS}}

# What continuous integration runs: formatting, clippy, docs, tests, figures up to date.
[group('develop')]
ci:
    bash .ci/run

//! Small scenes: each runs in a fraction of a second.

/// Regular and disordered claims in one and two dimensions.
pub(crate) const SMALL: &str = r#"[study]
title = "A small study"
seed = 7

[cases]
kernels = ["wendland-c2"]
lattices = ["line", "square"]
disorders = ["offset:0.1", "box:0.4"]

[claims]
use = ["fatehi-eq-33", "fatehi-eq-28", "fatehi-eq-38"]

[[claims.own]]
name = "mine"
moment = "sum_ddw"
quantity = "regular-deviation"
displacement = "0"
h = "-2"
dx_over_h = "beta-1"

[[ladders.regular]]
dimension = 1
from = 5
to = 32
rungs = 6
offsets = 4

[[ladders.regular]]
dimension = 2
from = 4
to = 16
rungs = 5
offsets = 3

[[ladders.disorder]]
dimension = 1
from = 6
to = 33
rungs = 7
offsets = 5

[[ladders.disorder]]
dimension = 2
from = 3
to = 12
rungs = 8
offsets = 1

[[ladders.displacement]]
dimension = 1
support_over_dx = 4.5
rungs = 9

[[ladders.displacement]]
dimension = 2
support_over_dx = 3.5
rungs = 10

[samples]
block = 8
precision = 0.1
most_blocks = 3

[comparison]
margin = 0.25

[limits]
memory_mib = 64
"#;

/// One dimension, exact sums alone.
pub(crate) const REGULAR: &str = r#"
[cases]
kernels = ["wendland-c2"]
lattices = ["line"]

[[ladders.regular]]
dimension = 1
from = 4
to = 32
rungs = 6
offsets = 4
"#;

/// One dimension, disorder alone.
pub(crate) const DISORDERED: &str = r#"
[[ladders.disorder]]
dimension = 1
from = 4
to = 16
rungs = 5
offsets = 1

[[ladders.displacement]]
dimension = 1
support_over_dx = 4.5
rungs = 5
"#;

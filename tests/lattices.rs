//! Lattices: neighbours, volumes, computed symmetry, the sums that vanish and those that do not, and lattices of one's own.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::cargo::cargo_bin_cmd;
use remainder::exact::{MultiIndex, Radical, Rational, int, ratio};
use remainder::kernel::{self, Kernel};
use remainder::particles::lattice::catalogue;
use remainder::particles::{Lattice, PointGroup, VolumeRule, lattice_by_id, sites_are_equivalent};
use remainder::study::{Scene, SceneText};
use remainder::sums::{LatticeSums, Moment, Reduction, SumError};
use std::collections::BTreeMap;

fn lattice(id: &str) -> Lattice {
    lattice_by_id(id).unwrap()
}

fn wendland() -> Kernel {
    kernel::by_id("wendland-c2").unwrap()
}

/// The nearest shells: (|r|², how many).
fn shells(lattice: &Lattice, radius: f64, count: usize) -> Vec<(Rational, usize)> {
    let mut shells: BTreeMap<Rational, usize> = BTreeMap::new();
    for k in lattice.indices_within(radius) {
        *shells.entry(lattice.square(&k)).or_default() += 1;
    }
    shells.into_iter().skip(1).take(count).collect()
}

#[test]
fn nearest_neighbours_stand_where_textbooks_put_them() {
    let expected: [(&str, &[(Rational, usize)]); 8] = [
        ("line", &[(int(1), 2), (int(4), 2)]),
        ("square", &[(int(1), 4), (int(2), 4)]),
        ("staggered", &[(int(1), 2), (ratio(5, 4), 4)]),
        ("hexagonal", &[(int(1), 6), (int(3), 6)]),
        ("simple-cubic", &[(int(1), 6), (int(2), 12), (int(3), 8)]),
        ("bcc", &[(ratio(3, 4), 8), (int(1), 6), (int(2), 12)]),
        ("fcc", &[(ratio(1, 2), 12), (int(1), 6), (ratio(3, 2), 24)]),
        // The shell at 8/3 tells hcp from fcc.
        ("hcp", &[(int(1), 12), (int(2), 6), (ratio(8, 3), 2), (int(3), 18), (ratio(11, 3), 12)]),
    ];
    assert_eq!(catalogue().len(), expected.len());
    for (id, expected) in expected {
        assert_eq!(shells(&lattice(id), 2.1, expected.len()), expected, "{id}");
        assert_eq!(lattice(id).least_square(), expected[0].0, "{id}");
    }
}

#[test]
fn volumes_and_point_groups() {
    let root = |p, q| Radical::sqrt_of(&ratio(p, q)).unwrap();
    let expected = [
        ("line", int(1).into(), 2, true),
        ("square", int(1).into(), 8, true),
        ("staggered", int(1).into(), 4, true),
        ("hexagonal", root(3, 4), 12, true),
        ("simple-cubic", int(1).into(), 48, true),
        ("bcc", ratio(1, 2).into(), 48, true),
        ("fcc", ratio(1, 4).into(), 48, true),
        ("hcp", root(1, 2), 12, false),
    ];
    for (id, volume, order, inversion) in expected {
        let (lattice, group) = (lattice(id), PointGroup::of(&lattice(id)));
        assert_eq!(lattice.particle_volume(), volume, "{id}");
        assert_eq!((group.order(), group.has_inversion()), (order, inversion), "{id}");
        assert!(sites_are_equivalent(&lattice), "{id}");
        // Volumes counted: particles in a large ball over its volume.
        let radius = [400.0, 60.0, 14.0][lattice.dimension() - 1];
        let counted = lattice.sites_within(radius).len() as f64;
        let ratio = counted / lattice.estimate_within(radius);
        assert!((ratio - 1.0).abs() < 0.01, "{id}: {ratio}");
    }
}

/// The operations of the group are isometries that map the sites around i onto each other: asked of positions, not of
/// vectors.
#[test]
fn operations_carry_neighbourhoods_onto_themselves() {
    for lattice in catalogue() {
        let units = lattice.axis_units();
        let mut sites: Vec<[i64; 3]> =
            lattice.sites_within(2.6).iter().map(|s| rounded(s.position)).collect();
        sites.sort_unstable();
        for operation in PointGroup::of(&lattice).operations() {
            let number = |a: usize, b: usize| remainder::exact::rational_to_f64(&operation[a][b]);
            let mut images: Vec<[i64; 3]> = lattice
                .sites_within(2.6)
                .iter()
                .map(|site| {
                    let k: [f64; 3] =
                        std::array::from_fn(
                            |a| if units[a] > 0.0 { site.position[a] / units[a] } else { 0.0 },
                        );
                    rounded(std::array::from_fn(|a| {
                        (0..3).map(|b| number(a, b) * k[b]).sum::<f64>() * units[a]
                    }))
                })
                .collect();
            images.sort_unstable();
            assert_eq!(images, sites, "{}", lattice.id());
        }
    }
}

fn rounded(position: [f64; 3]) -> [i64; 3] {
    position.map(|x| (x * 1e6).round() as i64)
}

/// A monomial sums to zero over every shell exactly if its mean over the group vanishes: sums over positions in floating
/// point with a weight that falls with |r| against the group, from both sides.
#[test]
fn monomials_vanish_where_symmetry_says_so_and_nowhere_else() {
    for lattice in catalogue() {
        let group = PointGroup::of(&lattice);
        for order in 1..=5 {
            for monomial in MultiIndex::all(lattice.dimension(), order).unwrap() {
                let (sum, size) = lattice.sites_within(3.3).iter().fold((0.0, 0.0), |(sum, size), site| {
                    let r = site.position;
                    let square: f64 = r.iter().map(|x| x * x).sum();
                    let value = (0..3).map(|a| r[a].powi(i32::from(monomial.powers[a]))).product::<f64>();
                    let weight = (1.0 - square / 11.0).powi(3);
                    (sum + weight * value, size + (weight * value).abs())
                });
                let (id, name) = (lattice.id(), monomial.letters());
                if group.mean(&monomial).is_zero() {
                    assert!(sum.abs() <= 1e-13 * size, "{id} {name}: {sum} of {size}");
                } else {
                    assert!(sum.abs() > 1e-4 * size, "{id} {name}: {sum} of {size}");
                }
            }
        }
    }
}

#[test]
fn odd_moments_vanish_on_all_lattices_but_hcp() {
    let moments =
        ["sum_dw", "sum_rw", "sum_rrdw", "sum_rddw", "sum_rrrrdw"].map(|m| Moment::by_name(m).unwrap());
    let support = ratio(13, 5);
    for lattice in catalogue() {
        let group = PointGroup::of(&lattice);
        let sums = LatticeSums::new(&wendland(), &lattice, &support, &moments, 64).unwrap();
        for moment in moments {
            let reduction = Reduction::of(moment, &lattice, &group);
            let vectors = moment.positions() + moment.derivatives() == 1;
            let survives = lattice.id() == "hcp" && !vectors;
            assert_eq!(reduction.vanishes(), !survives, "{} {moment}", lattice.id());
            for component in reduction.free() {
                let value = sums.exact(&support, &component, VolumeRule::Constant).unwrap();
                assert!(value.to_f64().abs() > 1e-3, "{} {moment}: {value}", lattice.id());
            }
        }
        for even in ["sum_w", "b_inverse", "sum_ddw", "sum_rrrdw", "sum_rrddw"] {
            assert!(!Reduction::of(Moment::by_name(even).unwrap(), &lattice, &group).vanishes(), "{even}");
        }
    }
}

/// D3h of an hcp site: of Σωrr∇W, xx|y = xy|x = −yy|y is all there is, Eq. (29) of Fatehi & Manzari fails.
#[test]
fn what_is_left_of_the_third_rank_on_hcp() {
    let (hcp, moment) = (lattice("hcp"), Moment::by_name("sum_rrdw").unwrap());
    let reduction = Reduction::of(moment, &hcp, &PointGroup::of(&hcp));
    let free = reduction.free();
    assert_eq!(free.len(), 1);
    let sums = LatticeSums::new(&wendland(), &hcp, &ratio(13, 5), &[moment], 64).unwrap();
    let value = |name: &str| {
        let component = reduction.components.iter().find(|c| c.name == name).unwrap();
        sums.exact(&ratio(13, 5), component, VolumeRule::Constant).unwrap().to_f64()
    };
    let (xxy, xyx, yyy) = (value("xxy"), value("xyx"), value("yyy"));
    assert!(xxy.abs() > 1e-3 && (xxy - xyx).abs() < 1e-15 && (xxy + yyy).abs() < 1e-15, "{xxy} {xyx} {yyy}");
    for name in ["xxx", "yyx", "xxz", "zzz", "zzy", "xyz"] {
        assert_eq!(value(name), 0.0, "{name}");
    }
}

/// Exact sums against plain sums over positions, on lattices whose axes have different units.
#[test]
fn exact_sums_agree_with_sums_over_positions() {
    for id in ["staggered", "bcc", "fcc", "hcp"] {
        let (lattice, kernel, support) = (lattice(id), wendland(), ratio(5, 2));
        let (d, radius) = (lattice.dimension(), 2.5_f64);
        let moments = ["sum_w", "sum_rrw", "sum_rrrw"].map(|m| Moment::by_name(m).unwrap());
        let sums = LatticeSums::new(&kernel, &lattice, &support, &moments, 64).unwrap();
        let volume = lattice.particle_volume().enclose(64).midpoint_f64();
        for moment in moments {
            for component in moment.components(d) {
                let exact = sums.exact(&support, &component, VolumeRule::Constant).unwrap().to_f64();
                let powers = component.terms[0].monomial.powers;
                // Wendland C2: σ (1 − q)⁴ (1 + 4q), q = r/R, σ = 7/π and 21/(2π).
                let sigma = [7.0, 10.5][d - 2] / std::f64::consts::PI / radius.powi(d as i32);
                let plain: f64 = lattice
                    .sites_within(radius)
                    .iter()
                    .map(|site| {
                        let q = site.position.iter().map(|x| x * x).sum::<f64>().sqrt() / radius;
                        let power = |a: usize| (-site.position[a]).powi(i32::from(powers[a]));
                        let w = sigma * (1.0 - q).max(0.0).powi(4) * (1.0 + 4.0 * q);
                        volume * w * power(0) * power(1) * power(2)
                    })
                    .sum();
                // r_ij = −r_j: odd powers would come out with the other sign on hcp if they ran over r_j.
                assert!((exact - plain).abs() < 1e-12, "{id} {moment} {}: {exact} {plain}", component.name);
            }
        }
    }
}

fn scene(define: &str, id: &str) -> Result<Scene, String> {
    let text = format!(
        "[cases]\nkernels = [\"wendland-c2\"]\nlattices = [\"{id}\"]\ndisorders = [\"offset:0.01\"]\n\n[[define.lattice]]\n{define}"
    );
    Scene::from_text(&SceneText { path: "own.toml".into(), text }, "own", false).map_err(|e| e.to_string())
}

fn own(define: &str) -> Lattice {
    scene(&format!("id = \"own\"\n{define}"), "own").unwrap().cases.remove(0).lattice
}

/// Every component of some moments at two supports, as text of the closed form.
fn closed_forms(lattice: &Lattice, rule: VolumeRule) -> Vec<String> {
    let moments = ["sum_w", "b_inverse", "sum_rrdw", "sum_ddw"].map(|m| Moment::by_name(m).unwrap());
    let sums = LatticeSums::new(&wendland(), lattice, &int(3), &moments, 64).unwrap();
    let mut forms = Vec::new();
    for support in [ratio(5, 2), int(3)] {
        for component in moments.iter().flat_map(|m| m.components(lattice.dimension())) {
            forms.push(sums.exact(&support, &component, rule).unwrap().to_string());
        }
    }
    forms
}

#[test]
fn own_lattices_that_are_the_catalogues_give_its_closed_forms() {
    let same: [(&str, &str); 8] = [
        ("square", "dimension = 2\nvectors = [['1','0'],['0','1']]"),
        // Any unit of length, and a cell as slanted as one likes.
        ("square", "dimension = 2\nvectors = [['7/3','0'],['0','7/3']]\nbasis = [['1/2','5']]"),
        ("square", "dimension = 2\nvectors = [['1','0'],['100','1']]"),
        ("staggered", "dimension = 2\nvectors = [['1','0'],['1/2','1']]"),
        ("hexagonal", "dimension = 2\nvectors = [['1','0'],['1/2','1/2']]\naxis_squares = ['1','3']"),
        // The conventional cells.
        (
            "bcc",
            "dimension = 3\nvectors = [['1','0','0'],['0','1','0'],['0','0','1']]\nbasis = [['0','0','0'],['1/2','1/2','1/2']]",
        ),
        (
            "fcc",
            "dimension = 3\nvectors = [['1','0','0'],['0','1','0'],['0','0','1']]\n\
             basis = [['0','0','0'],['0','1/2','1/2'],['1/2','0','1/2'],['1/2','1/2','0']]",
        ),
        (
            "hcp",
            "dimension = 3\nvectors = [['1','0','0'],['1/2','1/2','0'],['0','0','1']]\n\
             basis = [['0','0','0'],['1/2','1/6','1/2']]\naxis_squares = ['1','3','8/3']\nunit = 'nearest-neighbour'",
        ),
    ];
    for (id, define) in same {
        let (own, known) = (own(define), lattice(id));
        assert_eq!(PointGroup::of(&own).order(), PointGroup::of(&known).order(), "{id}");
        for rule in VolumeRule::ALL {
            assert_eq!(closed_forms(&own, rule), closed_forms(&known, rule), "{id} {rule}");
        }
    }
}

#[test]
fn a_honeycomb_is_scaled_to_its_nearest_neighbour() {
    let written =
        own("dimension = 2\nvectors = [['1','0'],['1/2','1/2']]\nbasis = [['0','0'],['1/2','1/6']]\n\
                       axis_squares = ['1','3']\nunit = 'nearest-neighbour'");
    // By hand, nearest distance 1: a₁ = (√3, 0), a₂ = (√3/2, 3/2), basis (0, 0), (√3/2, 1/2).
    let by_hand = Lattice::new(
        "honeycomb",
        "honeycomb",
        2,
        [ratio(3, 4), ratio(1, 4), int(1)],
        [[2, 0, 0], [1, 3, 0], [0, 0, 0]],
        vec![[0, 0, 0], [1, 1, 0]],
    )
    .unwrap();
    assert_eq!(shells(&written, 2.1, 3), [(int(1), 3), (int(3), 6), (int(4), 3)]);
    let group = PointGroup::of(&written);
    assert_eq!((group.order(), group.has_inversion()), (6, false));
    for rule in VolumeRule::ALL {
        assert_eq!(closed_forms(&written, rule), closed_forms(&by_hand, rule));
    }
    let third = Reduction::of(Moment::by_name("sum_rrdw").unwrap(), &written, &group);
    assert!(!third.vanishes());
    // In units of the cell edge, √3 times farther apart, it holds three times as many particles.
    let edge = own(
        "dimension = 2\nvectors = [['1','0'],['1/2','1/2']]\nbasis = [['0','0'],['1/2','1/6']]\naxis_squares = ['1','3']",
    );
    assert_eq!(edge.least_square(), ratio(1, 3));
}

#[test]
fn a_one_sided_pair_has_no_inversion_and_no_common_volume() {
    let pair = own("dimension = 1\nvectors = [['1']]\nbasis = [['0'],['1/3']]");
    assert_eq!((PointGroup::of(&pair).order(), PointGroup::of(&pair).has_inversion()), (1, false));
    // Two particles reflected into each other are equivalent, three at 0, 1/4, 1/2 are not.
    assert!(sites_are_equivalent(&pair));
    let three = own("dimension = 1\nvectors = [['1']]\nbasis = [['0'],['1/4'],['1/2']]");
    assert!(!sites_are_equivalent(&three));
    let moment = Moment::by_name("sum_w").unwrap();
    let sums = LatticeSums::new(&wendland(), &three, &int(2), &[moment], 64).unwrap();
    let component = &moment.components(1)[0];
    assert!(sums.exact(&int(2), component, VolumeRule::Constant).is_ok());
    let refused = sums.exact(&int(2), component, VolumeRule::NumberDensity).unwrap_err();
    assert_eq!(refused, SumError::UnequalVolumes { lattice: "own".into() });
    let refused = sums.enclose(&int(2), std::slice::from_ref(component), VolumeRule::NumberDensity, 64);
    assert!(matches!(refused, Err(SumError::UnequalVolumes { .. })));
}

#[test]
fn coordinates_too_fine_for_whole_numbers_are_refused_not_wrapped() {
    let fine = own("dimension = 3\nvectors = [['1','0','0'],['1/9999','1','0'],['0','1/9998','1']]");
    let moment = Moment::by_name("sum_rrrrrrddw").unwrap();
    let refused = LatticeSums::new(&wendland(), &fine, &int(48), &[moment], 4096).unwrap_err();
    assert!(matches!(refused, SumError::TooFine { .. }), "{refused}");
}

#[test]
fn rows_are_counted_along_the_last_axis() {
    let honeycomb = own(
        "dimension = 2\nvectors = [['1','0'],['1/2','1/2']]\nbasis = [['0','0'],['1/2','1/6']]\naxis_squares = ['1','3']",
    );
    for lattice in catalogue().into_iter().chain([honeycomb]) {
        let last = lattice.dimension() - 1;
        let mut heights: BTreeMap<i64, i64> = BTreeMap::new();
        for site in lattice.sites_within(3.0) {
            let height = (site.position[last] * 1e6).round() as i64;
            let row = lattice.row(site.cell, site.basis);
            assert_eq!(*heights.entry(height).or_insert(row), row, "{}", lattice.id());
        }
        assert_eq!(heights[&0], 0);
        // Rising heights are consecutive rows.
        let rows: Vec<i64> = heights.into_values().collect();
        assert!(rows.windows(2).all(|pair| pair[1] == pair[0] + 1), "{}: {rows:?}", lattice.id());
    }
}

#[test]
fn faults_of_a_scenes_lattice_exit_2_at_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let square = "vectors = [[\"1\", \"0\"], [\"0\", \"1\"]]";
    let cases: [(&str, String, &[&str]); 14] = [
        (
            "dependent",
            "dimension = 2\nvectors = [[\"1\", \"2\"], [\"2\", \"4\"]]".into(),
            &[":8:", "linearly dependent"],
        ),
        (
            "twice",
            format!("dimension = 2\n{square}\nbasis = [[\"0\", \"0\"], [\"3\", \"-1\"]]"),
            &[":9:22", "one place"],
        ),
        (
            "unit",
            format!("dimension = 2\n{square}\nunit = \"cell-edg\""),
            &[":9:", "did you mean 'cell-edge'"],
        ),
        ("vectors", "dimension = 2\nvectors = [[\"1\", \"0\"]]".into(), &[":8:", "1 vectors in dimension 2"]),
        (
            "coordinates",
            "dimension = 2\nvectors = [[\"1\", \"0\"], [\"1\"]]".into(),
            &[":8:24", "1 coordinates"],
        ),
        ("dimension", format!("dimension = 4\n{square}"), &[":7:", "dimension 4 is not 1, 2 or 3"]),
        ("number", "dimension = 1\nvectors = [[\"√2\"]]".into(), &[":8:", "√2"]),
        ("zero", "dimension = 1\nvectors = [[\"0\"]]".into(), &[":8:", "linearly dependent"]),
        (
            "squares",
            format!("dimension = 2\n{square}\naxis_squares = [\"1\", \"0\"]"),
            &[":9:", "must be positive"],
        ),
        ("short", format!("dimension = 2\n{square}\naxis_squares = [\"1\"]"), &[":9:", "1 axis squares"]),
        (
            "huge",
            "dimension = 1\nvectors = [[\"1\"]]\nbasis = [[\"0\"], [\"1/1000003\"]]".into(),
            &["common measure"],
        ),
        ("extra", format!("dimension = 2\n{square}\ncolour = 3"), &[":9:", "colour"]),
        ("hcp", format!("dimension = 2\n{square}"), &[":6:", "of the catalogue"]),
        ("a/b", format!("dimension = 2\n{square}"), &[":6:", "is no id"]),
    ];
    for (id, define, wanted) in cases {
        let path = folder.path().join("scene.toml");
        let head =
            format!("[cases]\nkernels = [\"wendland-c2\"]\nlattices = [\"{id}\"]\n\n[[define.lattice]]\n");
        std::fs::write(&path, format!("{head}id = \"{id}\"\n{define}\n")).unwrap();
        let output = cargo_bin_cmd!("remainder").arg("plan").arg(&path).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{id}: {message}");
        for part in wanted {
            assert!(message.contains(part), "{id}: no '{part}' in {message}");
        }
        assert!(!message.contains("panicked"), "{id}: {message}");
    }
    // The nearest name is sought among one's own as well.
    let error = scene("id = \"brick\"\ndimension = 1\nvectors = [['1']]", "brik").unwrap_err();
    assert!(error.contains("did you mean 'brick'"), "{error}");
}

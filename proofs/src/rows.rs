//! The bounds: what the library claims, and what is proved of it.

use crate::count::{Polynomial, rational, to_double, unit_roundoff, wide, worst};
use crate::kernels::{Kernel, named};
use crate::library::*;

/// The Frobenius norm of an accepted R: its square is the trace of RᵀR, at most 3.03. It bounds ‖|R|‖.
pub const FROBENIUS: f64 = 1.7407;

/// The spectral norm of an accepted R: that of RᵀR is at most 1.03.
pub const STRETCH: f64 = 1.015;

/// A bound.
pub struct Row {
    /// Where it stands.
    pub place: &'static str,
    /// What is bounded.
    pub what: &'static str,
    /// What the code allows for, in u of what it is relative to.
    pub claimed: f64,
    /// What is proved, in the same unit.
    pub proved: f64,
    /// By what.
    pub how: &'static str,
}

/// A number with a little more than rounding can have made of it.
fn above(x: f64) -> f64 {
    x * (1.0 + 1e-12)
}

/// In u, rounded up.
pub fn in_u(x: &dashu_ratio::RBig) -> f64 {
    above(to_double(&(x / unit_roundoff())))
}

/// The most that rounding makes of any coefficient of a value, fused or not, in u.
pub fn most(kernels: &[Kernel], kernel: &str, values: &[&str]) -> f64 {
    let forms = ["_fused", "_plain", ""].map(|form| format!("{kernel}{form}"));
    let found = forms.iter().filter(|name| kernels.iter().any(|kernel| kernel.name == **name));
    let worst = |name: &String| {
        let kernel = named(kernels, name);
        values.iter().map(|value| above(to_double(&worst(&kernel.polynomial(value))))).fold(0.0, f64::max)
    };
    found.map(worst).fold(0.0, f64::max)
}

/// The coefficient of a monomial: at least, in u; and the same over 1 for coefficients next to it.
pub fn low(polynomial: &Polynomial, monomial: &[&str]) -> f64 {
    let key: Vec<String> = monomial.iter().map(|name| name.to_string()).collect();
    let coefficient = polynomial.get(&key).unwrap_or_else(|| panic!("no {monomial:?} in {:?}", polynomial.keys()));
    to_double(&(&coefficient.low / unit_roundoff())) * (1.0 - 1e-12)
}

/// By how much a value is more than what it is the length of, in u: at least and at most.
fn raised(polynomial: &Polynomial) -> [f64; 2] {
    let coefficient = polynomial.values().next().expect("a length");
    [&coefficient.low, &coefficient.high].map(|end| to_double(&((end - rational(1.0)) / unit_roundoff())))
}

/// All bounds that are counted on tapes. What is proved by Gappa or Coq alone is in `scripts.rs`.
pub fn rows(kernels: &[Kernel]) -> Vec<Row> {
    let most = |kernel: &str, values: &[&str]| most(kernels, kernel, values);
    let of = |kernel: &str, value: &str| named(kernels, kernel).polynomial(value);
    let row = |place, what, claimed, proved, how| Row { place, what, claimed, proved, how };
    let root2 = 2f64.sqrt();

    let turned = most("difference", &["first0", "first1", "first2", "second0", "second1", "second2"]);
    let sums = most("difference", &["sum0", "sum1", "sum2"]);
    let offset = most("difference", &["offset0", "offset1", "offset2"]);
    let error = of("bounds", "difference_error");
    let of_plane = low(&of("bounds", "plane"), &["size"]) - low(&of("bounds", "difference"), &["size"]);
    let back = most("rotate_back", &["g0", "g1", "g2"]);
    let forth = most("rotate_back", &["x0", "x1", "x2"]);
    let product = most("certificate", &["projection"]);
    let interval_lower = of("interval", "lower");
    let distance = -to_double(&(&interval_lower[&vec!["distance".to_string()]].high / unit_roundoff()));
    let determinant = most("enclosure", &["determinant0", "determinant1", "determinant2", "determinant3"]);
    let bound = of("determinant_error", "bound");
    let cross = most("planes", &["cross0", "cross1", "cross2"]);
    let over = most("planes", &["over"]);
    let unit = most("planes", &["normal"]);
    let placed = most("fan", &["normal0", "normal1", "normal2"]);
    let corner = most("fan", &["corner0", "corner1", "corner2"]);
    let summed = most("fan", &["point0", "point1", "point2"]);
    let least = most("fan", &["least"]);
    let reach = most("fan", &["reach"]);
    let separations: Vec<[f64; 2]> =
        ["difference_fused", "difference_plain"].iter().map(|kernel| raised(&of(kernel, "separation"))).collect();
    let separation_low = separations.iter().map(|ends| ends[0]).fold(f64::INFINITY, f64::min);
    let separation_high = separations.iter().map(|ends| ends[1]).fold(0.0, f64::max);
    let way = most("gjk", &["way"]);
    let on_way = most("gjk", &["point"]);
    let excess = most("gjk", &["excess"]);
    let along = low(&of("edges_plain", "error"), &["along"]);
    // R·ê, its product with a length, and sums, each rounded by u of itself: of the tails, at most |D| and the lengths along both
    // edges; of a foot and a tail, at most |D| and one of the lengths; and |D|.
    let feet = of("edges_plain", "feet");
    let of_feet = |monomial: &[&str]| {
        let key: Vec<String> = monomial.iter().map(|name| name.to_string()).collect();
        feet[&key].relative().iter().map(|end| to_double(end).abs()).fold(0.0, f64::max)
    };
    let (of_product, of_tails) = (of_feet(&["a0", "s"]) - of_feet(&["d0"]), of_feet(&["d0"]) + sums);
    let rotated = most("rotate_back", &["x0", "x1", "x2"]) * FROBENIUS;
    let along_edges = rotated + of_product * STRETCH + of_tails - 1.0;
    // U·Rê: R·ê as rounded, and the last sum of U. From a foot, too: the product, its correction (x and 2 − x), and the part that
    // is taken off; |Rê|² ≤ 1.0303. The slopes: RᵀU and products. 12u are what planes of a feature miss each other by.
    let (across, between) = (of("edges_plain", "across"), of("edges_plain", "between"));
    let out_of_cone = rotated + 1.0;
    let foot = (most("edges", &["projected"]) + most("edges", &["square"]) * 1.0303 + 1.0 + of_product) * 1.0303;
    let slopes = back * FROBENIUS + most("plane_values", &["slope"]) * STRETCH;
    let (axis, speed) = (most("turned", &["axis"]), most("turned", &["speed"]));
    // R + sin·[a]R + (1 − cos)·[a]²R: both matrices by the axis and as rounded, both weights, and entries as rounded.
    let crossed = most("turned", &["crossed"]) * above(2.0 / 3f64.sqrt()) * FROBENIUS;
    let (by_sine, by_versine) = (axis * STRETCH + crossed, 2.0 * (axis * STRETCH + crossed));
    let of_weights = (4.0 + 4.0 + 2.0 * most("turned", &["versine"])) * STRETCH;
    let of_entries = most("turned", &["entry"]) * above(2.0 + 2f64.sqrt()) * FROBENIUS;
    let of_turn = by_versine + by_sine.hypot(by_versine) + of_weights + of_entries;
    let of_wide = |name: &str| {
        let kernel = named(kernels, "wide");
        let (_, node) = kernel.roots.iter().find(|(own, _)| own == name).expect("a root");
        wide(&kernel.tape, *node)
    };
    let cancelled = low(&of("bounds", "separation"), &["cancelled"]);
    // Where centres are not origins: the terms' rounding and that of their sums is left off, and summed.
    let left_off = (1.0 + most("offset", &["sum"])) * most("offset", &["rest"]);
    // The offset, of its bound: rounded once, with that sum.
    let of_offset = offset.max(left_off / cancelled);
    let (lower, upper) = (of("round_ends", "lower_of_segments"), of("round_ends", "upper_of_segments"));
    let (lower_points, upper_points) = (of("round_ends", "lower_of_points"), of("round_ends", "upper_of_points"));
    let taken = |lower: &Polynomial, name: &str| -in_u(&lower[&vec![name.to_string()]].high);
    let added = |upper: &Polynomial| in_u(&(&upper[&vec!["distance".to_string()]].exact - rational(1.0)));
    let off = |polynomial: &Polynomial, name: &str| {
        polynomial[&vec![name.to_string()]].relative().iter().map(|end| to_double(end).abs()).fold(0.0, f64::max)
    };
    let in_round = |what: &str| most("round", &[0, 1, 2].map(|k| format!("{what}{k}")).each_ref().map(String::as_str));
    // Of ends as rotated, which points between them share; of sums by themselves. No difference is longer than `separation` and
    // STRETCH times the size, nor a way than 2·STRETCH radii. The multiple of a way is rounded where it is not fused.
    let rotated_ends = ["tail1_", "tail2_", "head1_", "head2_"].map(in_round).into_iter().fold(0.0, f64::max);
    let of_both_tails = in_round("seen") + in_round("tails");
    let [of_moved, of_apart] = ["moved0", "apart0"].map(|value| off(&of("round_plain", value), "d"));
    let of_way1 = in_round("way1_") + in_round("moved") - of_moved;
    let of_way2 = in_round("way2_") + in_round("apart") - of_apart;
    let of_radius1 = 2.0 * STRETCH * of_way1;
    let of_radius2 = 2.0 * STRETCH * (of_way2 + of_moved) + in_round("seen") * STRETCH;
    let of_size = rotated_ends * FROBENIUS + of_both_tails * STRETCH + of_radius1.max(of_radius2);
    let length = most("certificate", &["distance"]);
    // Of the squares of balls' distances and radii: what is computed of both, and what is left of a radius.
    let of_square = 2.0 * most("balls", &["difference_x", "difference_y", "difference_z"]) + most("balls", &["square"]);
    let of_inner = 2.0 * most("balls", &["inner"]);
    let limit = of("balls", "limit");
    let spare = in_u(&(rational(1.0) - &limit[&vec!["inner".to_string(); 2]].exact));
    let left = of("balls", "shrunk");
    let of_defect = in_u(&(rational(1.0) - &left[&vec!["r".to_string()]].exact));
    // The most that is measured of an entry is 1e-2, and twice that is taken off.
    let of_radius = off(&left, "r") + 0.02 * most("balls", &["shrunk"]);

    vec![
        row(
            "frame `difference_error`",
            "of ρ₁ + ρ₂",
            low(&error, &["size"]),
            turned * FROBENIUS + sums * STRETCH,
            "G, C, Coq",
        ),
        row("", "of \\|Δ\\|", low(&error, &["separation"]), offset, "G, C, Coq"),
        row("", "of \\|D\\|; what is of second order is in \\|Δ\\|", low(&error, &["length"]), 2.0 * sums, "G, C, Coq"),
        row("frame `separation`", "it is raised by at least what \\|Δ\\| may lack", separation_low, offset, "C, Coq"),
        row("`between_spheres`", "it is raised by at most", 16.0, separation_high + offset, "C, Coq"),
        row(
            "frame `RIGID_DEFECT`",
            "‖RᵀR − I‖, lanes",
            RIGID_DEFECT / U,
            above(5f64.sqrt()) * RIGID_TOGETHER / U + 6.5,
            "G, Coq",
        ),
        row("", "‖RᵀR − I‖, entry by entry", RIGID_DEFECT / U, 3.0 * RIGID / U + 7.5, "G, Coq"),
        row("certificate `ends`", "of \\|D\\|, in the lower end", distance, product, "C, Coq"),
        row("`DIRECTION_ERROR`", "of \\|g\\|", DIRECTION_ERROR / U, back * FROBENIUS * 1.0153, "C"),
        row(
            "`RIGID_MISFIT`",
            "R·n, without 12u for planes",
            RIGID_MISFIT / U - 12.0,
            RIGID_DEFECT / U + forth * FROBENIUS,
            "C",
        ),
        row("`is_inside_sides`", "a value at q, of \\|q\\|", 4.0, most("plane_values", &["value"]), "C"),
        row("`STRICT`", "of it, the product", 3.0, most("plane_values", &["slope"]), "C"),
        row(
            "`HEIGHTS`",
            "of ρ\\|g\\|, two heights",
            HEIGHTS / U,
            2.0 * (most("plane_values", &["high"]) + DIRECTION_ERROR / U),
            "C",
        ),
        row("enclosure", "a determinant, of W³", low(&bound, &["L", "L", "L"]), determinant * root2, "C, Coq"),
        row("polytope `plane`", "of M", of_plane / 1.02, over + unit, "C"),
        row("polytope `determinant`", "of M\\|e\\|\\|g\\|", of_plane / 1.02, (cross + 2.0) * root2 + over, "C"),
        row("facets `NORMAL`", "of \\|n\\|", NORMAL / U, RIGID_DEFECT / U + placed * FROBENIUS + 2.5, "C"),
        row(
            "facets `NODE`",
            "of M",
            NODE / U,
            ((NORMAL / U + corner * FROBENIUS + least * STRETCH + summed) / 1.02).max(NORMAL / U + reach + offset)
                + 1.0,
            "C",
        ),
        row("facets `SUPPORT`", "of M", SUPPORT / U, corner * FROBENIUS + summed + offset + least + 1.0 + 3.0, "C"),
        row(
            "facets `ON_ARC`",
            "of the direction's length",
            ON_ARC / U,
            above(8f64.sqrt()) * NORMAL / U + 22.0,
            "C, Coq",
        ),
        row("gjk `EXCESS`", "of ρ\\|g\\|", EXCESS / U, 2.0 * DIRECTION_ERROR / U + 2.0 * excess, "C"),
        row("gjk `COMBINATION`", "of ρ", COMBINATION / U, 2.0 * way + 2.0 * on_way + 6.0, "C"),
        row("predicates `FILTER`", "of the spread", FILTER / U, most("predicates", &["height"]) + 3.0, "C"),
        row("normal `unit`", "a component", 4.0, most("normals", &["unit"]), "C"),
        row("slack `HEIGHT`", "of the magnitudes", HEIGHT / U, most("normals", &["height"]) + 1.0, "C"),
        // The loss is at most B, as the excess is at most 2B; its own rounding and that of the rise count twice and once. The ends'
        // directions are of unit length up to 4u; a gap below 0 may be too high by 8u of itself.
        row(
            "motion `least_between`",
            "of both gaps and B",
            LEAST_BETWEEN / U,
            most("least_within", &["least"]) + 2.0 + 1.0 + 1.0 + 4.0 + 8.0,
            "C",
        ),
        row("verify `CLEAR`", "of the lengths' product", CLEAR / U, most("gjk", &["determinant"]) * root2 + 6.1, "C"),
        // The side is the rotated difference of two vertices, the vertex is off by 8u of the reach, and ‖R‖ takes part.
        row(
            "ray `SIDE`",
            "of \\|d\\|\\|side\\|·reach",
            SIDE / U,
            most("gjk", &["determinant"]) * root2 + (1.0 + STRETCH) + most("pose", &["turned"]) * FROBENIUS + 8.3,
            "C",
        ),
        row("ray, motion", "R·p, of ρ", 5.3, most("pose", &["turned"]) * FROBENIUS, "C"),
        row("`of_edge`", "the remainder, of its parts", REMAINDER / U, most("remainder", &["edge"]), "C"),
        row("`of_face`", "the remainder, of its parts", REMAINDER / U, most("remainder", &["face"]), "C"),
        row(
            "round `ends_of_segments`",
            "of ρ₁ + ρ₂, in the lower end",
            taken(&lower, "size"),
            turned * FROBENIUS + sums * STRETCH + (2.0 * sums + product + off(&lower, "least")) * STRETCH,
            "C, Coq",
        ),
        row(
            "",
            "of \\|Δ\\|, in the lower end",
            taken(&lower, "separation"),
            of_offset + 2.0 * sums + product + off(&lower, "least"),
            "C, Coq",
        ),
        row("", "of ρ₁ + ρ₂, in the upper end", low(&upper, &["size"]), of_size, "C, Coq"),
        row("", "of \\|Δ\\|, in the upper end", low(&upper, &["separation"]), of_offset + of_both_tails, "C, Coq"),
        row(
            "",
            "of the length, in the upper end",
            added(&upper),
            of_moved + of_apart + length + off(&upper, "distance"),
            "C, Coq",
        ),
        // Half of what the square is off by, its root: the length without its own rounding.
        row(
            "round `ends_of_points`",
            "of \\|Δ\\|, in the lower end",
            taken(&lower_points, "separation"),
            of_offset + (length - 1.0) + most("round_ends", &["along"]) + off(&lower_points, "least"),
            "C",
        ),
        row("", "of \\|Δ\\|, in the upper end", low(&upper_points, &["separation"]), of_offset, "C"),
        row("", "of the length, in the upper end", added(&upper_points), length + off(&upper_points, "distance"), "C"),
        row(
            "glance `square_of_rigid`",
            "of the square",
            spare,
            of_square + of_inner + most("balls", &["limit"]) + RIGID_DEFECT / U,
            "C, Coq",
        ),
        // Measuring errs by 3u of entries up to 1.01 in their squares, and counts twice.
        row(
            "glance `shrunk`",
            "of the radius, without 2d",
            of_defect,
            (of_square + of_inner + 1.0) / 2.0 + of_radius + 2.0 * 4.0,
            "C",
        ),
        row("states, edges", "a difference, of lengths along edges", along, along_edges, "C"),
        row("", "a difference, of \\|D\\|", along, of_tails, "C"),
        row("states, misfits", "vertex and edge, of \\|U\\|", low(&across, &[]), out_of_cone + foot + 12.0, "C"),
        row("", "vertex and edge, of the length along it", low(&across, &["inverse", "|leaning|"]), foot, "C"),
        row("", "two edges, of \\|U\\|", low(&between, &[]), out_of_cone + slopes + 12.0, "C"),
        row(
            "",
            "two edges, of 1",
            low(&between, &["inverse"]),
            (most("edges", &["cross"]) - 1.0) * root2 * 1.0303,
            "C",
        ),
        row("motion `Turn`", "a component of the axis", 6.5, axis, "C"),
        row("", "the speed", 5.5, speed, "C"),
        row(
            "`rounding_of_pose`",
            "a turn, of its angle",
            OF_ANGLE,
            (speed + most("turned", &["angle"])) * STRETCH,
            "C",
        ),
        row("", "a turn, beside that", OF_TURN, of_turn, "C"),
        // M is the sum of the magnitudes of all terms. `separation` makes 2u of 16u·M.
        row("frame `with_centres`", "of M, in u²", 2.0 * cancelled, left_off, "C"),
        // Of double-doubles.
        row(
            "predicates `DOUBLE_DOUBLE_FILTER`",
            "of the spread, in u²",
            DOUBLE_DOUBLE_FILTER / (U * U),
            of_wide("height"),
            "C, Coq",
        ),
        row("verify `ERROR`", "a difference, of the size, in u²", ERROR / (U * U), of_wide("difference"), "C, Coq"),
        row("", "a gap, of \\|n\\| and the size, in u²", ERROR / (U * U), of_wide("gap"), "C, Coq"),
    ]
}

/// What has to hold beside the rows, in exact rationals: coefficients that cover what they are to cover.
///
/// # Errors
/// What does not.
pub fn check(kernels: &[Kernel]) -> Result<(), String> {
    let of = |kernel: &str, value: &str| named(kernels, kernel).polynomial(value);
    let one = rational(1.0);
    let (lower, upper) = (of("interval", "lower"), of("interval", "upper"));
    let key = |name: &str| vec![name.to_string()];
    let spare = rational(8.0 * U);
    let distance_low = ["certificate_fused", "certificate_plain"]
        .map(|kernel| of(kernel, "distance").values().next().expect("a length").low.clone());
    let conditions = [
        ("lower: the projection is not raised", lower[&key("projection")].high <= one),
        ("lower: the excess is covered", -lower[&key("excess")].high.clone() >= one),
        ("lower: the error is covered but for 8u", -lower[&key("error")].high.clone() >= &one - spare),
        ("upper: the distance is covered", distance_low.iter().all(|low| low * &upper[&key("distance")].low >= one)),
        ("upper: the error is covered", upper[&key("error")].low >= one),
        ("upper: the point's error is covered", upper[&key("point")].low >= one),
        ("enclosure: the longest is raised", {
            let [low, _] = raised(&of("determinant_error", "longest"));
            low >= 1.5
        }),
    ];
    for (what, holds) in conditions {
        if !holds {
            return Err(what.to_string());
        }
    }
    let bound = of("determinant_error", "bound");
    for (monomial, needed) in [(["E", "L", "L"], 3.0), (["E", "E", "L"], 6.0), (["E", "E", "E"], 3.0)] {
        let key: Vec<String> = monomial.iter().map(|name| name.to_string()).collect();
        if bound[&key].low < rational(needed) {
            return Err(format!("enclosure: {monomial:?} is not covered"));
        }
    }
    for row in rows(kernels) {
        // What is of second order the factors 1 + 4u of the ends cover.
        if !(row.proved <= row.claimed + 1e-9) {
            return Err(format!("{} {}: {} is claimed, {} is proved", row.place, row.what, row.claimed, row.proved));
        }
    }
    Ok(())
}

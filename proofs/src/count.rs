//! What rounding may make of a value on a tape.
//!
//! Each operation rounds to (1 + e) times its exact result, |e| ≤ u (`coq/model.v`: nothing under- or overflows, rounding is to
//! nearest). So a value is a polynomial of the inputs, in which each monomial has a coefficient of its own that depends on the
//! errors alone. Here it is bounded by an interval of rationals. A root of a sum of squares whose coefficients are within [a, b]
//! is the root of the exact sum times a factor within [√a, √b]; that and a reciprocal are new inputs.

use std::collections::BTreeMap;

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use crate::tape::{Node, Op, Tape, parts};

/// A product of inputs by their names, in order.
pub type Monomial = Vec<String>;

/// A coefficient: what it is in exact arithmetic, and between what rounding leaves it.
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficient {
    /// Without rounding.
    pub exact: RBig,
    /// At least this …
    pub low: RBig,
    /// … and at most this.
    pub high: RBig,
    /// As an expression of the errors e_node, for Gappa and Coq.
    pub text: String,
}

/// A value by its monomials.
pub type Polynomial = BTreeMap<Monomial, Coefficient>;

/// u.
pub fn unit_roundoff() -> RBig {
    RBig::from_parts(IBig::ONE, UBig::ONE << 53)
}

/// A double, exactly.
pub fn rational(x: f64) -> RBig {
    let (mantissa, exponent) = parts(x);
    let power = UBig::ONE << exponent.unsigned_abs() as usize;
    if exponent < 0 {
        RBig::from_parts(mantissa.into(), power)
    } else {
        RBig::from(IBig::from(mantissa) * IBig::from(power))
    }
}

/// A rational to the double next above it, about: for reports.
pub fn to_double(x: &RBig) -> f64 {
    x.to_f64().value()
}

fn least(all: [RBig; 4]) -> RBig {
    all.into_iter().reduce(|a, b| if b < a { b } else { a }).expect("four")
}

fn greatest(all: [RBig; 4]) -> RBig {
    all.into_iter().reduce(|a, b| if b > a { b } else { a }).expect("four")
}

impl Coefficient {
    fn of(exact: RBig, text: String) -> Coefficient {
        Coefficient { low: exact.clone(), high: exact.clone(), exact, text }
    }

    fn plus(&self, other: &Coefficient) -> Coefficient {
        Coefficient {
            exact: &self.exact + &other.exact,
            low: &self.low + &other.low,
            high: &self.high + &other.high,
            text: format!("({} + {})", self.text, other.text),
        }
    }

    fn times(&self, other: &Coefficient) -> Coefficient {
        let products =
            || [&self.low * &other.low, &self.low * &other.high, &self.high * &other.low, &self.high * &other.high];
        let text = match (self.text.as_str(), other.text.as_str()) {
            ("1", text) | (text, "1") => text.to_string(),
            (a, b) => format!("{a} * {b}"),
        };
        Coefficient { exact: &self.exact * &other.exact, low: least(products()), high: greatest(products()), text }
    }

    fn negated(&self) -> Coefficient {
        Coefficient {
            exact: -self.exact.clone(),
            low: -self.high.clone(),
            high: -self.low.clone(),
            text: format!("(-{})", self.text),
        }
    }

    fn rounded(&self, node: Node) -> Coefficient {
        let (one, u) = (RBig::ONE, unit_roundoff());
        let error = Coefficient { exact: one.clone(), low: &one - &u, high: one + u, text: format!("(1 + e{node})") };
        self.times(&error)
    }

    /// How far rounding takes it from what it is, in u of itself, upwards and downwards.
    ///
    /// # Panics
    /// If it is 0: terms that cancel leave what rounding makes of them.
    pub fn relative(&self) -> [RBig; 2] {
        assert!(self.exact != RBig::ZERO, "terms cancel: {}", self.text);
        let u = unit_roundoff();
        let ends = [(&self.low - &self.exact) / &self.exact / &u, (&self.high - &self.exact) / &self.exact / u];
        let [a, b] = ends;
        if a <= b { [a, b] } else { [b, a] }
    }
}

/// The most that rounding takes any coefficient from what it is, in u of itself.
pub fn worst(polynomial: &Polynomial) -> RBig {
    let ends = polynomial.values().flat_map(|coefficient| {
        let [low, high] = coefficient.relative();
        [-low, high]
    });
    ends.reduce(|a, b| if b > a { b } else { a }).expect("a monomial")
}

/// The most that a sum or difference of double-doubles is off by, in u² of the magnitudes of both (`coq/double_double.v`).
pub const WIDE_SUM: f64 = 3.0;

/// The most that a product of double-doubles is off by, in u² of the product of the magnitudes (`coq/double_double.v`).
pub const WIDE_PRODUCT: f64 = 8.0;

/// What a value is off by, in u² of the sum of the magnitudes of its terms, where each number on the tape is a double-double.
///
/// # Panics
/// If there is another operation than sums and products.
pub fn wide(tape: &Tape, node: Node) -> f64 {
    let operands: Vec<f64> = tape.operands(node).iter().map(|node| wide(tape, *node)).collect();
    match (tape.op(node), &operands[..]) {
        (Op::Input, _) => 0.0,
        (Op::Add | Op::Sub, [a, b]) => a.max(*b) + WIDE_SUM,
        (Op::Mul, [a, b]) => a + b + WIDE_PRODUCT,
        (op, _) => panic!("{op:?} of double-doubles"),
    }
}

/// Counts below cuts, which are inputs by the names they are given.
pub struct Counter<'a> {
    tape: &'a Tape,
    /// By name.
    pub cuts: BTreeMap<Node, String>,
    known: BTreeMap<Node, Polynomial>,
    /// The roots: where they are, by which name, and between what the factor f_node of each is.
    pub roots: Vec<(Node, String, [RBig; 2])>,
}

impl<'a> Counter<'a> {
    /// On a tape.
    pub fn new(tape: &'a Tape, cuts: impl IntoIterator<Item = (Node, String)>) -> Counter<'a> {
        Counter { tape, cuts: cuts.into_iter().collect(), known: BTreeMap::new(), roots: Vec::new() }
    }

    /// The polynomial of a node.
    ///
    /// # Panics
    /// For what is no polynomial.
    pub fn count(&mut self, node: Node) -> Polynomial {
        if let Some(known) = self.known.get(&node) {
            return known.clone();
        }
        let found = self.compute(node);
        self.known.insert(node, found.clone());
        found
    }

    fn compute(&mut self, node: Node) -> Polynomial {
        let atom = |name: &str| BTreeMap::from([(vec![name.to_string()], Coefficient::of(RBig::ONE, "1".into()))]);
        if let Some(name) = self.cuts.get(&node) {
            return atom(name);
        }
        let operands: Vec<Polynomial> =
            self.tape.operands(node).to_vec().into_iter().map(|node| self.count(node)).collect();
        match (self.tape.op(node), &operands[..]) {
            (Op::Input, _) => atom(self.tape.name(node)),
            (Op::Constant, _) => {
                let x = rational(self.tape.value(node));
                if x == RBig::ZERO {
                    return Polynomial::new();
                }
                BTreeMap::from([(Vec::new(), Coefficient::of(x, format!("c{node}")))])
            }
            (Op::Add, [a, b]) => rounded(&sum(a, b), node),
            (Op::Sub, [a, b]) => rounded(&sum(a, &negated(b)), node),
            // By a power of two nothing is rounded, see the limits of scale.
            (Op::Mul, [a, b]) if self.tape.operands(node).iter().any(|node| self.is_power_of_two(*node)) => {
                product(a, b)
            }
            (Op::Mul, [a, b]) => rounded(&product(a, b), node),
            (Op::Fma, [a, b, c]) => rounded(&sum(&product(a, b), c), node),
            (Op::Fnma, [a, b, c]) => rounded(&sum(c, &negated(&product(a, b))), node),
            (Op::Neg, [a]) => negated(a),
            (Op::Abs, [a]) => magnitude(a),
            (Op::Sqrt, [a]) => self.root(a, node),
            (Op::Div, [a, b]) => rounded(&product(a, &reciprocal(b)), node),
            (op, _) => panic!("node {node}, {op:?}, is no polynomial"),
        }
    }

    fn is_power_of_two(&self, node: Node) -> bool {
        let (mantissa, _) = parts(self.tape.value(node));
        self.tape.op(node) == Op::Constant && (mantissa.unsigned_abs()).is_power_of_two()
    }

    /// The root of a sum of squares: 1 + t/2 − t²/2 ≤ √(1 + t) ≤ 1 + t/2 (`coq/lemmas.v`).
    fn root(&mut self, square: &Polynomial, node: Node) -> Polynomial {
        for (monomial, coefficient) in square {
            let is_square = monomial.chunks(2).all(|pair| pair.len() == 2 && pair[0] == pair[1]);
            assert!((is_square || monomial.len() == 1) && coefficient.exact > RBig::ZERO, "{monomial:?} is no square");
        }
        let ends = square.values().flat_map(|c| [&c.low / &c.exact, &c.high / &c.exact]);
        let (low, high) = ends.fold((RBig::ONE, RBig::ONE), |(low, high), end| {
            (if end < low { end.clone() } else { low }, if end > high { end } else { high })
        });
        let half = RBig::from_parts(IBig::ONE, UBig::from(2u8));
        let (below, above) = (low - RBig::ONE, high - RBig::ONE);
        let low = RBig::ONE + &below * &half - &below * &below * &half;
        let high = RBig::ONE + above * half;
        let name = if square.len() == 1 && square.keys().next().is_some_and(|monomial| monomial.len() == 1) {
            format!("root_{}", square.keys().next().expect("one")[0])
        } else {
            format!("root{node}")
        };
        self.roots.push((node, name.clone(), [low.clone(), high.clone()]));
        let factor = Coefficient { exact: RBig::ONE, low, high, text: format!("f{node}") };
        BTreeMap::from([(vec![name], factor.rounded(node))])
    }
}

fn sum(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut sum = a.clone();
    for (monomial, coefficient) in b {
        let total = sum.get(monomial).map_or_else(|| coefficient.clone(), |own| own.plus(coefficient));
        sum.insert(monomial.clone(), total);
    }
    sum
}

fn negated(a: &Polynomial) -> Polynomial {
    a.iter().map(|(monomial, coefficient)| (monomial.clone(), coefficient.negated())).collect()
}

fn product(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut all = Polynomial::new();
    for (left, c) in a {
        for (right, d) in b {
            let mut monomial = [left.clone(), right.clone()].concat();
            monomial.sort();
            // x·(1/x) = 1.
            while let Some((at, inverse)) = monomial.iter().enumerate().find_map(|(at, name)| {
                let other = name.strip_prefix('/')?;
                Some((at, monomial.iter().position(|name| name == other)?))
            }) {
                monomial.remove(at.max(inverse));
                monomial.remove(at.min(inverse));
            }
            all = sum(&all, &BTreeMap::from([(monomial, c.times(d))]));
        }
    }
    all
}

fn rounded(a: &Polynomial, node: Node) -> Polynomial {
    a.iter().map(|(monomial, coefficient)| (monomial.clone(), coefficient.rounded(node))).collect()
}

fn single(a: &Polynomial) -> (&Monomial, &Coefficient) {
    assert!(a.len() == 1, "{:?} is no product", a.keys());
    a.iter().next().expect("one")
}

fn magnitude(a: &Polynomial) -> Polynomial {
    let (monomial, coefficient) = single(a);
    let positive = if coefficient.exact < RBig::ZERO { coefficient.negated() } else { coefficient.clone() };
    BTreeMap::from([(monomial.iter().map(|name| format!("|{name}|")).collect(), positive)])
}

fn reciprocal(a: &Polynomial) -> Polynomial {
    let (monomial, c) = single(a);
    assert!(c.low > RBig::ZERO, "a divisor is positive");
    let inverse = |x: &RBig| RBig::ONE / x;
    let coefficient = Coefficient {
        exact: inverse(&c.exact),
        low: inverse(&c.high),
        high: inverse(&c.low),
        text: format!("(1 / ({}))", c.text),
    };
    let turned = |name: &String| name.strip_prefix('/').map_or_else(|| format!("/{name}"), str::to_string);
    let mut monomial: Monomial = monomial.iter().map(turned).collect();
    monomial.sort();
    BTreeMap::from([(monomial, coefficient)])
}

//! The tape: what was computed, operation by operation, each with the double that it is.
//!
//! Numbers leave the lanes as plain doubles and come back. They are known again by their bits: inputs are random, so that no two
//! numbers are equal by chance. What comes back and is not known, nor a short constant, is *opaque*: arithmetic on doubles that was
//! not seen. No result may rest on it.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write;

/// What a node is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Op {
    /// A named number.
    Input,
    /// A constant of the code.
    Constant,
    /// Not seen.
    Opaque,
    /// a + b.
    Add,
    /// a − b.
    Sub,
    /// a·b.
    Mul,
    /// a·b + c, rounded once.
    Fma,
    /// c − a·b, rounded once.
    Fnma,
    /// −a.
    Neg,
    /// a/b.
    Div,
    /// √a.
    Sqrt,
    /// |a|.
    Abs,
}

/// A node, by its number.
pub type Node = u32;

/// What was compared.
#[derive(Debug, Clone, Copy)]
pub struct Claim {
    /// The left side.
    pub left: Node,
    /// `>` or `<=`.
    pub relation: &'static str,
    /// The right side.
    pub right: Node,
}

#[derive(Debug, Clone)]
struct Record {
    op: Op,
    operands: [Node; 3],
    value: f64,
    name: String,
}

/// A tape.
#[derive(Debug, Clone, Default)]
pub struct Tape {
    records: Vec<Record>,
    by_bits: HashMap<u64, Node>,
    is_fused: bool,
    /// In order.
    pub claims: Vec<Claim>,
}

thread_local! { static CURRENT: RefCell<Tape> = RefCell::default(); }

fn with<T>(f: impl FnOnce(&mut Tape) -> T) -> T {
    CURRENT.with(|tape| f(&mut tape.borrow_mut()))
}

/// Begins a new tape, of a machine that fuses or one that does not.
pub fn begin(is_fused: bool) {
    with(|tape| *tape = Tape { is_fused, ..Tape::default() });
}

/// The tape so far.
pub fn finished() -> Tape {
    with(|tape| tape.clone())
}

/// Whether the machine fuses.
pub fn is_fused() -> bool {
    with(|tape| tape.is_fused)
}

fn append(tape: &mut Tape, op: Op, operands: [Node; 3], value: f64, name: &str) -> Node {
    tape.records.push(Record { op, operands, value, name: name.to_string() });
    tape.records.len() as Node - 1
}

/// What a node is as a double.
pub fn value(node: Node) -> f64 {
    with(|tape| tape.records[node as usize].value)
}

/// A named input; the double is known by its bits from now on.
pub fn input(name: &str, x: f64) -> Node {
    with(|tape| {
        let node = append(tape, Op::Input, [0; 3], x, name);
        tape.by_bits.insert(x.to_bits(), node);
        node
    })
}

/// A constant that the code names as one.
pub fn constant(x: f64) -> Node {
    with(|tape| append(tape, Op::Constant, [0; 3], x, ""))
}

/// An operation.
pub fn push(op: Op, operands: [Node; 3]) -> Node {
    with(|tape| {
        let [a, b, c] = operands.map(|node| tape.records[node as usize].value);
        let value = match op {
            Op::Add => a + b,
            Op::Sub => a - b,
            Op::Mul => a * b,
            Op::Fma => a.mul_add(b, c),
            Op::Fnma => (-a).mul_add(b, c),
            Op::Neg => -a,
            Op::Div => a / b,
            Op::Sqrt => a.sqrt(),
            Op::Abs => a.abs(),
            Op::Input | Op::Constant | Op::Opaque => f64::NAN,
        };
        let node = append(tape, op, operands, value, "");
        // All results are known again, whether they leave as doubles or are computed elsewhere by the same formula.
        if value != 0.0 && value.is_finite() {
            tape.by_bits.entry(value.to_bits()).or_insert(node);
        }
        node
    })
}

/// A double that comes into the lanes.
pub fn known(x: f64) -> Node {
    let found = with(|tape| [x, -x].map(|x| tape.by_bits.get(&x.to_bits()).copied()));
    // What the code writes as n or n·u has few bits.
    let is_short = !x.is_finite() || x.to_bits() << 12 << 16 == 0;
    match found {
        _ if is_short => constant(x),
        [Some(node), _] => node,
        [None, Some(node)] => push(Op::Neg, [node, node, node]),
        [None, None] => {
            // The root of what is known, which lanes leave for.
            let is_square = |record: &Record| record.value > 0.0 && record.value.sqrt().to_bits() == x.to_bits();
            match with(|tape| tape.records.iter().position(is_square)) {
                Some(square) => push(Op::Sqrt, [square as Node; 3]),
                None => with(|tape| append(tape, Op::Opaque, [0; 3], x, "")),
            }
        }
    }
}

/// The doubles that came into the lanes and were not known, in order.
pub fn unseen() -> Vec<f64> {
    with(|tape| tape.records.iter().filter(|record| record.op == Op::Opaque).map(|record| record.value).collect())
}

/// All nodes that are the same double as this one.
pub fn equal(node: Node) -> Vec<Node> {
    with(|tape| {
        let bits = tape.records[node as usize].value.to_bits();
        let is_equal = |other: &Node| tape.records[*other as usize].value.to_bits() == bits;
        (0..tape.records.len() as Node).filter(is_equal).collect()
    })
}

/// A comparison; whether it holds.
pub fn claim(left: Node, relation: &'static str, right: Node) -> bool {
    with(|tape| {
        tape.claims.push(Claim { left, relation, right });
        let [a, b] = [left, right].map(|node| tape.records[node as usize].value);
        if relation == ">" { a > b } else { a <= b }
    })
}

impl Tape {
    /// A node's operation.
    pub fn op(&self, node: Node) -> Op {
        self.records[node as usize].op
    }

    /// A node's operands, those that it has.
    pub fn operands(&self, node: Node) -> &[Node] {
        let Record { op, operands, .. } = &self.records[node as usize];
        match op {
            Op::Input | Op::Constant | Op::Opaque => &[],
            Op::Neg | Op::Sqrt | Op::Abs => &operands[..1],
            Op::Add | Op::Sub | Op::Mul | Op::Div => &operands[..2],
            Op::Fma | Op::Fnma => operands,
        }
    }

    /// A node's double.
    pub fn value(&self, node: Node) -> f64 {
        self.records[node as usize].value
    }

    /// Puts a constant in the place of another, for tests; how often.
    pub fn replace_constant(&mut self, from: f64, to: f64) -> usize {
        let is_it = |record: &&mut Record| record.op == Op::Constant && record.value.to_bits() == from.to_bits();
        self.records.iter_mut().filter(is_it).map(|record| record.value = to).count()
    }

    /// The name of an input.
    pub fn name(&self, node: Node) -> &str {
        &self.records[node as usize].name
    }

    /// All nodes that some roots rest on, down to the cuts, in order.
    pub fn below(&self, roots: &[Node], cuts: &BTreeMap<Node, String>) -> Vec<Node> {
        let mut needed = vec![false; self.records.len()];
        let mut open = roots.to_vec();
        while let Some(node) = open.pop() {
            if !std::mem::replace(&mut needed[node as usize], true) && !cuts.contains_key(&node) {
                open.extend(self.operands(node));
            }
        }
        (0..self.records.len() as Node).filter(|node| needed[*node as usize]).collect()
    }

    /// The tape below some roots and claims, as it is committed.
    ///
    /// # Panics
    /// If something rests on what was not seen.
    pub fn print(&self, roots: &[(String, Node)], claims: &[Claim]) -> String {
        let ends: Vec<Node> = roots
            .iter()
            .map(|(_, node)| *node)
            .chain(claims.iter().flat_map(|claim| [claim.left, claim.right]))
            .collect();
        let mut text = String::new();
        let mut words: HashMap<Node, String> = HashMap::new();
        for node in self.below(&ends, &BTreeMap::new()) {
            let word = match self.op(node) {
                Op::Opaque => panic!("node {node}, {:e}, is computed where it was not seen", self.value(node)),
                Op::Input => self.name(node).to_string(),
                Op::Constant => dyadic(self.value(node)),
                op => {
                    let word = format!("t{}", words.len());
                    let operands: Vec<&str> = self.operands(node).iter().map(|node| words[node].as_str()).collect();
                    let name = format!("{op:?}").to_lowercase();
                    writeln!(text, "{word} = {name} {}", operands.join(" ")).expect("a string");
                    word
                }
            };
            words.insert(node, word);
        }
        for (name, node) in roots {
            writeln!(text, "{name} = {}", words[node]).expect("a string");
        }
        for Claim { left, relation, right } in claims {
            writeln!(text, "claim {} {relation} {}", words[left], words[right]).expect("a string");
        }
        text
    }
}

/// A double as an odd integer times a power of two, as Gappa writes it.
pub fn dyadic(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let (mantissa, exponent) = parts(x);
    if exponent == 0 { format!("{mantissa}") } else { format!("{mantissa}b{exponent}") }
}

/// x = mantissa·2^exponent, the mantissa odd, or an integer that is small enough to read.
pub fn parts(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let raw = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mut mantissa, mut exponent) = if raw == 0 { (fraction, -1074) } else { (fraction | 1 << 52, raw - 1075) };
    while mantissa != 0 && mantissa & 1 == 0 && exponent != 0 {
        (mantissa, exponent) = (mantissa >> 1, exponent + 1);
    }
    (if x < 0.0 { -mantissa } else { mantissa }, exponent)
}

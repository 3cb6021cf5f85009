//! Scalars and lanes that write down what is done to them.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::library::{Lanes, Portable, Scalar, Vector, Work};
use crate::tape::{Node, Op, claim, constant, is_fused, known, push, value};

/// A scalar on the tape.
#[derive(Debug, Clone, Copy)]
pub struct Symbol(pub Node);

impl From<f64> for Symbol {
    fn from(x: f64) -> Symbol {
        Symbol(constant(x))
    }
}

fn two(op: Op, a: Node, b: Node) -> Node {
    push(op, [a, b, b])
}

fn one(op: Op, a: Node) -> Node {
    push(op, [a, a, a])
}

impl Add for Symbol {
    type Output = Symbol;
    fn add(self, other: Symbol) -> Symbol {
        Symbol(two(Op::Add, self.0, other.0))
    }
}

impl Sub for Symbol {
    type Output = Symbol;
    fn sub(self, other: Symbol) -> Symbol {
        Symbol(two(Op::Sub, self.0, other.0))
    }
}

impl Mul for Symbol {
    type Output = Symbol;
    fn mul(self, other: Symbol) -> Symbol {
        Symbol(two(Op::Mul, self.0, other.0))
    }
}

impl Div for Symbol {
    type Output = Symbol;
    fn div(self, other: Symbol) -> Symbol {
        Symbol(two(Op::Div, self.0, other.0))
    }
}

impl Neg for Symbol {
    type Output = Symbol;
    fn neg(self) -> Symbol {
        Symbol(one(Op::Neg, self.0))
    }
}

impl Scalar for Symbol {
    fn sqrt(self) -> Symbol {
        Symbol(one(Op::Sqrt, self.0))
    }
    fn abs(self) -> Symbol {
        Symbol(one(Op::Abs, self.0))
    }
}

/// Four nodes.
#[derive(Debug, Clone, Copy)]
pub struct Symbolic(pub [Node; 4]);

const LANES: [usize; 4] = [0, 1, 2, 3];

impl Symbolic {
    fn doubles(self) -> [f64; 4] {
        self.0.map(value)
    }

    fn portable(self) -> Portable {
        Portable::load(&self.doubles())
    }

    fn each(self, op: Op, other: Symbolic) -> Symbolic {
        Symbolic(LANES.map(|i| two(op, self.0[i], other.0[i])))
    }

    fn compared(self, relation: &'static str, other: Symbolic) -> u32 {
        LANES.iter().map(|&i| u32::from(claim(self.0[i], relation, other.0[i])) << i).sum()
    }
}

impl Lanes for Symbolic {
    type Twins = <Portable as Lanes>::Twins;
    /// Only `two_product` asks, which is exact either way.
    const IS_FUSED: bool = true;
    fn twins(self, second: Self) -> Self::Twins {
        self.portable().twins(second.portable())
    }
    fn splat(x: f64) -> Self {
        Symbolic([known(x); 4])
    }
    fn load(x: &[f64; 4]) -> Self {
        Symbolic(x.map(known))
    }
    fn to_array(self) -> [f64; 4] {
        self.doubles()
    }
    fn store_vector(self, to: &mut [f64; 3]) {
        let [x, y, z, _] = self.doubles();
        *to = [x, y, z];
    }
    fn load_single(x: &[u32; 4]) -> Self {
        Self::load(&Portable::load_single(x).to_array())
    }
    fn store_single(self, to: &mut [u32; 4]) {
        self.portable().store_single(to);
    }
    fn from_vector(v: &Vector) -> Self {
        Self::load(&[v.x, v.y, v.z, v.z])
    }
    fn to_vector(self) -> Vector {
        let [x, y, z, _] = self.doubles();
        Vector::new(x, y, z)
    }
    fn add(self, other: Self) -> Self {
        self.each(Op::Add, other)
    }
    fn sub(self, other: Self) -> Self {
        self.each(Op::Sub, other)
    }
    fn mul(self, other: Self) -> Self {
        self.each(Op::Mul, other)
    }
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        if is_fused() {
            Symbolic(LANES.map(|i| push(Op::Fma, [self.0[i], factor.0[i], addend.0[i]])))
        } else {
            self.mul(factor).add(addend)
        }
    }
    fn negated_mul_add(self, factor: Self, addend: Self) -> Self {
        if is_fused() {
            Symbolic(LANES.map(|i| push(Op::Fnma, [self.0[i], factor.0[i], addend.0[i]])))
        } else {
            addend.sub(self.mul(factor))
        }
    }
    fn negate(self) -> Self {
        Symbolic(self.0.map(|node| one(Op::Neg, node)))
    }
    fn greater(self, other: Self) -> u32 {
        self.compared(">", other)
    }
    fn splat_x(self) -> Self {
        Symbolic([self.0[0]; 4])
    }
    fn splat_y(self) -> Self {
        Symbolic([self.0[1]; 4])
    }
    fn splat_z(self) -> Self {
        Symbolic([self.0[2]; 4])
    }
    fn transpose(rows: &[Self; 3]) -> [Self; 4] {
        let zero = constant(0.0);
        LANES.map(|i| Symbolic([rows[0].0[i], rows[1].0[i], rows[2].0[i], zero]))
    }
    fn rotate(self) -> Self {
        let [x, y, z, w] = self.0;
        Symbolic([y, z, x, w])
    }
    fn dot(self, other: Self) -> f64 {
        let [x, y, z, _] = self.mul(other).0;
        value(two(Op::Add, two(Op::Add, x, y), z))
    }
    fn at_most(self, other: Self) -> u32 {
        self.compared("<=", other)
    }
    fn norm1(self) -> f64 {
        let [x, y, z, _] = self.0.map(|node| one(Op::Abs, node));
        value(two(Op::Add, two(Op::Add, x, y), z))
    }
    fn max(self, other: Self) -> Self {
        self.where_greater(self, other, other)
    }
    fn min(self, other: Self) -> Self {
        other.where_greater(self, other, self)
    }
    fn div(self, other: Self) -> Self {
        self.each(Op::Div, other)
    }
    fn sqrt(self) -> Self {
        Symbolic(self.0.map(|node| one(Op::Sqrt, node)))
    }
    fn components(vectors: &[Self; 4]) -> [Self; 3] {
        [0, 1, 2].map(|k| Symbolic(LANES.map(|i| vectors[i].0[k])))
    }
    /// What is chosen is chosen: the tape is of one path.
    fn where_greater(self, left: Self, right: Self, other: Self) -> Self {
        let (a, b) = (left.doubles(), right.doubles());
        Symbolic(LANES.map(|i| if a[i] > b[i] { self.0[i] } else { other.0[i] }))
    }
    fn with_first(self, other: Self) -> Self {
        let [_, y, z, w] = self.0;
        Symbolic([other.0[0], y, z, w])
    }
    fn upper_halves(first: Self, second: Self) -> Self {
        Symbolic([first.0[2], first.0[3], second.0[2], second.0[3]])
    }
    fn products_are_below(self, vectors: [&[f32; 8]; 3], limit: f32) -> bool {
        self.portable().products_are_below(vectors, limit)
    }
    fn greatest_product(self, vectors: [&[f32; 8]; 3]) -> (f32, usize) {
        self.portable().greatest_product(vectors)
    }
    fn extreme_products(self, vectors: &[[[f32; 8]; 3]]) -> [f32; 2] {
        self.portable().extreme_products(vectors)
    }
    fn farthest_product(self, vectors: &[[[f32; 8]; 3]]) -> (usize, [f32; 2]) {
        self.portable().farthest_product(vectors)
    }
    fn farthest_of(self, vectors: &[[[f32; 8]; 3]]) -> usize {
        self.farthest_product(vectors).0
    }
    fn least(self) -> (f64, usize) {
        self.portable().least()
    }
    fn out_of_line<W: Work>(work: &mut W) -> W::Output {
        work.run()
    }
}

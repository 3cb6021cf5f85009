//! The answer to a pair query: plain data, laid out for C.

/// The outcome of a pair query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum Outcome {
    /// Nothing is said yet: the value of a fresh answer.
    #[default]
    None = 0,
    /// The objects are disjoint, `0 < lower ≤ distance ≤ upper`; `lower` is 0 only for a distance below the smallest double.
    Separated = 1,
    /// The objects are disjoint and farther apart than `max_distance`. `lower` is at least that, `distance` is `lower`,
    /// `upper` is infinity, and along the unit normal the objects are at least `lower` apart. Points and features stay unset.
    Beyond = 2,
    /// The closed objects have a common point (touching included).
    Intersecting = 3,
    /// The objects may be disjoint or not, `0 = lower ≤ distance ≤ upper`: the step budget of an approximate query ran out before
    /// the verdict ([`DecidedBy::Budget`]), or the deviation of a cylinder, cone or ellipsoid hides it. Then normal, points and
    /// features are those of the polyhedra.
    Undecided = 4,
}

/// The method that decided a pair query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum DecidedBy {
    /// Nothing: the value of a fresh answer.
    #[default]
    None = 0,
    /// Voronoi marching: it ended, and its certificate holds.
    Marching = 1,
    /// What proved the last verdict, or nearly that: vertex pairs that enclose the origin, or a separating axis.
    Coherence = 2,
    /// Support vertices of the Minkowski difference, in floating point: a walk for a verdict, else Gilbert-Johnson-Keerthi.
    Fallback = 3,
    /// Integer arithmetic.
    Integers = 4,
    /// The errors that an approximate query may make: it stopped because its interval was narrow enough.
    Tolerance = 5,
    /// The step budget of an approximate query, which ran out: the interval holds, and the next query with the same cache goes on
    /// from there.
    Budget = 6,
    /// The bounding spheres: they are apart, and farther than `max_distance` if that is finite.
    BoundingSpheres = 7,
    /// Balls inside the objects overlap. Such an answer carries no vertex pairs as its proof.
    InscribedSpheres = 8,
}

/// Kind of a feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum FeatureKind {
    /// Nothing is said.
    #[default]
    None = 0,
    /// A vertex: `ids[0]` is its index in the caller's array.
    Vertex = 1,
    /// An edge: `ids` are the caller's indices of its two end vertices.
    Edge = 2,
    /// A face: `ids[0]` is the caller's index of a polygon that holds the witness point; of a contact of
    /// objects deep in each other one along which they overlap least. Of a hull that was made without polygons it is a
    /// number of the hull's own, from 0 and below its number of faces.
    Face = 3,
}

/// A feature in the caller's numbering.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct Feature {
    /// Vertex, edge or face.
    pub kind: FeatureKind,
    /// See [`FeatureKind`]; unused entries are 0.
    pub ids: [u32; 2],
}

/// Work of a query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct Statistics {
    /// Voronoi marching: feature pairs visited.
    pub marching_steps: u32,
    /// Support vertices of a verdict's walk; else Gilbert-Johnson-Keerthi iterations, of the fallback and of approximate queries.
    pub fallback_iterations: u32,
    /// Iterations in integer arithmetic. It allocates, and so does a query that makes a table or levels.
    pub exact_iterations: u32,
    /// The levels of detail of object 1 and object 2 that the answer comes from; 0 is the object itself.
    pub levels: [u16; 2],
}

/// The answer to a pair query. Unset numbers are NaN, features [`FeatureKind::None`]; a separated answer always
/// has a normal.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct PairAnswer {
    /// Disjoint, beyond `max_distance`, or intersecting.
    pub outcome: Outcome,
    /// Which rung of the search decided.
    pub decided_by: DecidedBy,
    /// The best estimate, `lower ≤ distance ≤ upper`; 0 when intersecting.
    pub distance: f64,
    /// Lower end of the rigorous interval; 0 when intersecting.
    pub lower: f64,
    /// Upper end of the rigorous interval; 0 when intersecting; +∞ for [`Outcome::Beyond`].
    pub upper: f64,
    /// Witness point on object 1, in its local frame.
    pub local1: [f64; 3],
    /// Witness point on object 2, in its local frame.
    pub local2: [f64; 3],
    /// Witness point on object 1, in the world frame.
    pub world1: [f64; 3],
    /// Witness point on object 2, in the world frame.
    pub world2: [f64; 3],
    /// Unit normal in the world frame, from object 2 to object 1.
    pub normal: [f64; 3],
    /// Nearest feature of object 1.
    pub feature1: Feature,
    /// Nearest feature of object 2.
    pub feature2: Feature,
    /// Intersecting: vertex pairs, in the caller's numbering, whose differences hold the origin in their hull.
    pub proof: [[u32; 2]; 4],
    /// How many entries of `proof` are used: 1 to 4 when intersecting, except for [`DecidedBy::InscribedSpheres`] and
    /// where objects intersect by their swept radii alone, else 0.
    pub proof_count: u32,
    /// Work of the query.
    pub statistics: Statistics,
}

impl PairAnswer {
    /// Says nothing: no number of it reads as a contact.
    pub(crate) const UNSAID: PairAnswer = {
        const UNSAID: [f64; 3] = [f64::NAN; 3];
        const NO_FEATURE: Feature = Feature { kind: FeatureKind::None, ids: [0; 2] };
        PairAnswer {
            outcome: Outcome::None,
            decided_by: DecidedBy::None,
            distance: f64::NAN,
            lower: f64::NAN,
            upper: f64::NAN,
            local1: UNSAID,
            local2: UNSAID,
            world1: UNSAID,
            world2: UNSAID,
            normal: UNSAID,
            feature1: NO_FEATURE,
            feature2: NO_FEATURE,
            proof: [[0; 2]; 4],
            proof_count: 0,
            statistics: Statistics { marching_steps: 0, fallback_iterations: 0, exact_iterations: 0, levels: [0; 2] },
        }
    };

    /// The answer of the same two objects, given the other way round.
    pub(crate) fn reversed(&self) -> PairAnswer {
        // The sum with +0 turns −0 into 0.
        let normal = self.normal.map(|x| -x + 0.0);
        let [level1, level2] = self.statistics.levels;
        PairAnswer {
            local1: self.local2,
            local2: self.local1,
            world1: self.world2,
            world2: self.world1,
            normal,
            feature1: self.feature2,
            feature2: self.feature1,
            proof: self.proof.map(|[vertex1, vertex2]| [vertex2, vertex1]),
            statistics: Statistics { levels: [level2, level1], ..self.statistics },
            ..*self
        }
    }
}

impl Default for PairAnswer {
    fn default() -> Self {
        PairAnswer::UNSAID
    }
}

//! A pair: both shapes, the march, the answer, the manifold and the polytope.

use super::target::{Draw, DrawKind, Pen};
use crate::answer::Outcome;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::simd::environment::with_default;
use crate::depth::for_each_triangle;
use crate::manifold::{ManifoldCache, ManifoldConfig, add_points, manifold_into};
use crate::pair::{PairConfig, SignedDistance, SignedDistanceCache, signed_distance};
use crate::placed::Pair;
use crate::shape::Placed;

/// Asks for the signed distance and the manifold of two objects, cold, and draws both shapes, the march, witness points and normal,
/// the points of the manifold and the polytope.
///
/// March and polytope are those of the polyhedra that radii are swept over, without levels of detail. `config` is that of the
/// manifold. A polytope that is too large to be kept is replaced by one of a less narrow search.
///
/// # Errors
/// As of [`manifold`](crate::manifold::manifold); nothing is drawn then.
pub fn pair(bodies: [Placed; 2], config: &ManifoldConfig, draw: &mut dyn Draw) -> Result<()> {
    with_default(|| {
        config.check()?;
        bodies.iter().try_for_each(|body| body.pose.check())?;
        let (mut answer, mut points) = (SignedDistance::default(), Vec::new());
        let mut pen = Pen::new(draw);
        if pen.wants(DrawKind::Contact) {
            let mut cache = ManifoldCache::default();
            add_points(&mut points, |sink| manifold_into(bodies, &mut cache, config, sink, None))??;
        }
        if [DrawKind::Witness, DrawKind::Normal, DrawKind::Polytope].into_iter().any(|kind| pen.wants(kind)) {
            signed_distance(bodies, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut answer)?;
        }
        bodies.iter().for_each(|body| pen.shape(*body));
        if pen.wants(DrawKind::March) || pen.wants(DrawKind::Feature) {
            pen.march(&bodies);
        }
        pen.witness(&answer);
        pen.contacts(&points);
        if pen.wants(DrawKind::Polytope) && answer.outcome == Outcome::Intersecting {
            pen.polytope(&bodies, &answer);
        }
        Ok(())
    })
}

impl Pen<'_> {
    fn polytope(&mut self, bodies: &[Placed; 2], answer: &SignedDistance) {
        self.point(DrawKind::Polytope, Vector::zeros());
        self.point(DrawKind::Polytope, Vector::from(answer.world1) - Vector::from(answer.world2));
        for_each_triangle(&Pair::of(bodies), |corners| {
            self.polygon(DrawKind::Polytope, corners.into_iter());
        });
    }
}

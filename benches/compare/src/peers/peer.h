/* What a library is behind, for mod.rs; each has these functions under names of its own. No exception leaves them.
 *
 *   peer_create    two meshes, and the tolerance of its queries; null where the library refuses one
 *   peer_load      the poses of a scene, in whatever form the library wants them; they stay where they are
 *   peer_forget    drops all coherence
 *   peer_free
 *   distance       at pose i, and along what, of any length and either sign; 0 of intersecting bodies, NaN of a failure
 *   verdict        0 of intersecting bodies, infinity of others
 *   depth          0 of bodies said to be apart
 *   manifold       the depth of its deepest point, likewise */
#ifndef COMPARE_PEER_H
#define COMPARE_PEER_H

#include <stddef.h>

struct peer_mesh {
    const double *vertices;
    size_t vertex_count;
    const unsigned *corners;
    size_t triangle_count;
    double radius; /* of a ball swept over it; above 0 for the ways of round bodies alone */
};

struct peer;

#endif

/* What a library that says depths is behind, for peers.rs; each has these functions under names of its own. No exception leaves
 * them.
 *
 *   create   two meshes; null where the library refuses one
 *   load     the poses of a scene, in whatever form the library wants them; they stay where they are
 *   forget   drops all coherence
 *   ask      the depth at pose i: 0 of bodies said to be apart, NaN of a failure; along which normal, of either sign
 *   free */
#ifndef COMPARE_DEPTH_PEER_H
#define COMPARE_DEPTH_PEER_H

#include <stddef.h>

struct peer_mesh {
    const double *vertices;
    size_t vertex_count;
    const unsigned *corners;
    size_t triangle_count;
};

struct peer;

#endif

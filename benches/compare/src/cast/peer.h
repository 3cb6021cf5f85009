/* What a library in C++ that finds first contacts is behind, for native.rs; each has these functions under names of its own. No
 * exception leaves them.
 *
 *   create   two meshes, and of each motion the row-major [R|T] of both bodies at the beginning and of both at the end; null where
 *            the library refuses one
 *   ask      the time of motion i's first contact, from 0 to 1; 2 of a free one, NaN of a failure
 *   free */
#ifndef COMPARE_CAST_PEER_H
#define COMPARE_CAST_PEER_H

#include "../peers/peer.h"

/* The time of a motion that is free. */
static const double FREE = 2;

#endif

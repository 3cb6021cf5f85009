/* For file readers that include it: what they need is in SWIFT_fileio.h. Meshes inside SWIFT are not offered. */
#ifndef SWIFT_MESH_H
#define SWIFT_MESH_H

#include "SWIFT_array.h"
#include "SWIFT_fileio.h"

#endif

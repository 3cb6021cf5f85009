/* A mesh that is not convex, as convex pieces. */
#ifndef SWIFT_LEGACY_SURFACE_PIECES_H
#define SWIFT_LEGACY_SURFACE_PIECES_H

#include "native.h"

namespace swift_legacy {

/* Whether SWIFT++ would decompose a mesh of these edges. */
inline bool is_decomposable(const Mesh& mesh)
{
#ifdef SWIFT_ALLOW_BOUNDARY
    (void)mesh;
    return true;
#else
    return surface_fault(mesh).empty();
#endif
}

/* The patches of a surface. False where it is not one; swiftprox_library_last_error_message says why, or what failed. */
inline bool pieces_of_surface(const Mesh& mesh, std::vector<Mesh>& pieces)
{
    if (!is_decomposable(mesh)) {
        return false;
    }
    /* A face of n corners is n - 2 triangles, and no face has fewer than three. */
    const std::size_t capacity = mesh.indices.size() - 2 * mesh.face_count;
    std::vector<uint32_t> corners(3 * capacity + 1), faces(capacity + 1), numbers(capacity + 1);
    swiftprox_decomposition found;
    found.corners = &corners[0];
    found.faces = &faces[0];
    found.pieces = &numbers[0];
    found.capacity = capacity;
    const swiftprox_mesh native = native_mesh(mesh);
    if (swiftprox_mesh_decompose(native, mesh.tolerance, NULL, NULL, &found) != SWIFTPROX_OK) {
        return false;
    }
    SubMesh piece(mesh);
    for (std::size_t t = 0; t < found.triangle_count; ++t) {
        int triangle[3];
        std::copy(&corners[3 * t], &corners[3 * t] + 3, triangle);
        const std::size_t face = faces[t];
        piece.add_triangle(triangle, mesh.face_labels.empty() ? static_cast<int>(face) : mesh.face_labels[face]);
        if (t + 1 == found.triangle_count || numbers[t + 1] != numbers[t]) {
            pieces.push_back(piece.mesh());
            piece.begin();
        }
    }
    return true;
}

} // namespace swift_legacy

#endif

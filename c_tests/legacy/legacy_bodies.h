/* Convex bodies for measurements. */
#ifndef LEGACY_BODIES_H
#define LEGACY_BODIES_H

#include <cmath>
#include <vector>

#include <SWIFT.h>

namespace {

struct Body {
    std::vector<SWIFT_Real> vertices;
    std::vector<int> triangles;
};

/* An ellipsoid of 25 rings of 40 vertices and two poles. */
Body ellipsoid()
{
    const int rings = 25, around = 40;
    const double pi = PI;
    Body body;
    for (int ring = 0; ring <= rings + 1; ++ring) {
        const double polar = pi * ring / (rings + 1);
        for (int i = 0; i < (ring % (rings + 1) == 0 ? 1 : around); ++i) {
            body.vertices.push_back(std::sin(polar) * std::cos(2 * pi * i / around));
            body.vertices.push_back(0.7 * std::sin(polar) * std::sin(2 * pi * i / around));
            body.vertices.push_back(0.5 * std::cos(polar));
        }
    }
    const int last = rings * around + 1;
    for (int i = 0; i < around; ++i) {
        const int next = (i + 1) % around, bottom = last - around;
        const int caps[6] = {0, 1 + i, 1 + next, last, bottom + next, bottom + i};
        body.triangles.insert(body.triangles.end(), caps, caps + 6);
        for (int ring = 1; ring < rings; ++ring) {
            const int above = 1 + (ring - 1) * around, below = above + around;
            const int two[6] = {above + i, below + i, below + next, above + i, below + next, above + next};
            body.triangles.insert(body.triangles.end(), two, two + 6);
        }
    }
    return body;
}

Body box()
{
    static const int sides[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    Body body;
    for (int v = 0; v < 8; ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            body.vertices.push_back((v >> axis & 1) == 0 ? -0.5 : 0.5);
        }
    }
    for (int side = 0; side < 6; ++side) {
        const int* q = sides + 4 * side;
        const int two[6] = {q[0], q[1], q[2], q[0], q[2], q[3]};
        body.triangles.insert(body.triangles.end(), two, two + 6);
    }
    return body;
}

} // namespace

#endif

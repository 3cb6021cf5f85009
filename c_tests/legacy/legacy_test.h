/* What the tests of SWIFT.h share: meshes whose distances are known, files, and what was said on std::cerr. */
#ifndef LEGACY_TEST_H
#define LEGACY_TEST_H

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <SWIFT.h>

#include "check.h"

/* Rounding of a few operations on numbers of the order of 1. */
#ifdef SWIFT_USE_FLOAT
const double ROUNDING = 1e-6;
#else
const double ROUNDING = 1e-14;
#endif

inline bool is_near(double a, double b)
{
    return std::fabs(a - b) <= ROUNDING * (1 + std::fabs(b));
}

inline bool is_same(double a, double b)
{
    return !(a < b) && !(a > b);
}

inline bool is_near3(const SWIFT_Real* a, double x, double y, double z)
{
    return is_near(a[0], x) && is_near(a[1], y) && is_near(a[2], z);
}

/* An axis-aligned box about the origin, of triangles or of six quadrangles. */
struct BoxMesh {
    SWIFT_Real vertices[24];
    int triangles[36];
    int quads[24];
    int valences[6];

    BoxMesh(double half_x, double half_y, double half_z)
    {
        static const int sides[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
        const double halves[3] = {half_x, half_y, half_z};
        for (int v = 0; v < 8; ++v) {
            for (int axis = 0; axis < 3; ++axis) {
                vertices[3 * v + axis] = static_cast<SWIFT_Real>((v >> axis & 1) == 0 ? -halves[axis] : halves[axis]);
            }
        }
        for (int side = 0; side < 6; ++side) {
            const int* q = sides + 4 * side;
            const int pair[6] = {q[0], q[1], q[2], q[0], q[2], q[3]};
            valences[side] = 4;
            std::copy(q, q + 4, quads + 4 * side);
            std::copy(pair, pair + 6, triangles + 6 * side);
        }
    }

    bool add(SWIFT_Scene& scene, int& id) const
    {
        return scene.Add_Convex_Object(vertices, triangles, 8, 12, id);
    }
};

/* An object where it is, not turned. */
inline void move_to(SWIFT_Scene& scene, int id, double x, double y, double z)
{
    const SWIFT_Real T[3] = {static_cast<SWIFT_Real>(x), static_cast<SWIFT_Real>(y), static_cast<SWIFT_Real>(z)};
    scene.Set_Object_Transformation(id, DEFAULT_ORIENTATION, T);
}

/* A rotation about an axis of coordinates, row-major. */
struct Rotation {
    SWIFT_Real m[9];

    Rotation(int axis, double angle)
    {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::copy(DEFAULT_ORIENTATION, DEFAULT_ORIENTATION + 9, m);
        m[3 * u + u] = m[3 * v + v] = static_cast<SWIFT_Real>(std::cos(angle));
        m[3 * v + u] = static_cast<SWIFT_Real>(std::sin(angle));
        m[3 * u + v] = -m[3 * v + u];
    }
};

/* p' = R p + T. */
inline void place_point(const SWIFT_Real* R, const SWIFT_Real* T, const SWIFT_Real* p, double* out)
{
    for (int i = 0; i < 3; ++i) {
        out[i] = R[3 * i] * p[0] + R[3 * i + 1] * p[1] + R[3 * i + 2] * p[2] + T[i];
    }
}

/* What is said on std::cerr while it lives. */
class Messages {
public:
    Messages() : before_(std::cerr.rdbuf(text_.rdbuf())) {}

    ~Messages()
    {
        std::cerr.rdbuf(before_);
    }

    /* Since the last time. */
    std::string take()
    {
        const std::string said = text_.str();
        text_.str("");
        return said;
    }

    bool has(const std::string& part)
    {
        return take().find(part) != std::string::npos;
    }

private:
    std::ostringstream text_;
    std::streambuf* before_;

    Messages(const Messages&);
    Messages& operator=(const Messages&);
};

/* Files in the folder that the program was given. */
class Folder {
public:
    Folder(int argc, char** argv) : path_(argc > 1 ? argv[1] : ".") {}

    std::string path(const std::string& name) const { return path_ + "/" + name; }

    std::string write(const std::string& name, const std::string& content) const
    {
        std::ofstream stream(path(name).c_str(), std::ios::out | std::ios::binary);
        stream << content;
        return path(name);
    }

private:
    std::string path_;
};

/* A box as the text of a TRI or a POLY file. */
inline std::string box_file(const BoxMesh& box, bool is_poly)
{
    std::ostringstream text;
    text << (is_poly ? "POLY\n8 6\n" : "TRI\n8 12\n");
    for (int i = 0; i < 24; ++i) {
        text << box.vertices[i] << (i % 3 == 2 ? '\n' : ' ');
    }
    for (int i = 0; is_poly && i < 24; ++i) {
        text << (i % 4 == 0 ? "4 " : "") << box.quads[i] << (i % 4 == 3 ? '\n' : ' ');
    }
    for (int i = 0; !is_poly && i < 36; ++i) {
        text << box.triangles[i] << (i % 3 == 2 ? '\n' : ' ');
    }
    return text.str();
}

#endif

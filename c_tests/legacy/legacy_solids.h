/* Solids that an old program makes and writes as text. */
#ifndef LEGACY_SOLIDS_H
#define LEGACY_SOLIDS_H

#include <iomanip>

#include "legacy_test.h"

/* From 0 to 1, the same numbers everywhere. */
class Numbers {
public:
    explicit Numbers(unsigned int seed) : state_(seed) {}

    double next()
    {
        state_ = state_ * 1664525u + 1013904223u;
        return (state_ >> 8) / 16777216.0;
    }

    /* Row-major, of a quaternion whose parts are these numbers. */
    void rotation(double* m)
    {
        double q[4], sum = 0;
        for (int i = 0; i < 4; ++i) {
            q[i] = next() - 0.5;
            sum += q[i] * q[i];
        }
        for (int i = 0; i < 4; ++i) {
            q[i] /= std::sqrt(sum);
        }
        const double w = q[0], x = q[1], y = q[2], z = q[3];
        const double rows[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                                2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                                2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
        std::copy(rows, rows + 9, m);
    }

private:
    unsigned int state_;
};

struct Solid {
    std::vector<double> vertices;
    std::vector<int> faces;
    std::vector<int> valences;

    void add_vertex(const double* m, double x, double y, double z)
    {
        for (int i = 0; i < 3; ++i) {
            vertices.push_back(m[3 * i] * x + m[3 * i + 1] * y + m[3 * i + 2] * z);
        }
    }

    void add_face(int count, const int* corners)
    {
        faces.insert(faces.end(), corners, corners + count);
        valences.push_back(count);
    }

    int vertex_count() const
    {
        return static_cast<int>(vertices.size() / 3);
    }

    int face_count() const
    {
        return static_cast<int>(valences.size());
    }

    /* As a program writes it. */
    std::string file(int decimals) const
    {
        std::ostringstream out;
        out << std::fixed << std::setprecision(decimals) << "POLY " << vertex_count() << ' ' << face_count() << '\n';
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            out << vertices[i] << (i % 3 == 2 ? '\n' : ' ');
        }
        std::size_t at = 0;
        for (std::size_t face = 0; face < valences.size(); ++face) {
            out << valences[face];
            for (int corner = 0; corner < valences[face]; ++corner) {
                out << ' ' << faces[at++];
            }
            out << '\n';
        }
        return out.str();
    }

    bool add(SWIFT_Scene& scene, int& id) const
    {
        const std::vector<SWIFT_Real> numbers = as_real();
        return scene.Add_Convex_Object(&numbers[0], &faces[0], vertex_count(), face_count(), id, false, DEFAULT_ORIENTATION,
                                       DEFAULT_TRANSLATION, 1, BOX_SETTING_DEFAULT, 0, 0, &valences[0]);
    }

    std::vector<SWIFT_Real> as_real() const
    {
        std::vector<SWIFT_Real> numbers;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            numbers.push_back(static_cast<SWIFT_Real>(vertices[i]));
        }
        return numbers;
    }
};

/* Turned some way, over a regular polygon. */
inline Solid prism(int sides, Numbers& numbers)
{
    const double pi = PI;
    double m[9];
    numbers.rotation(m);
    Solid solid;
    std::vector<int> bottom, top;
    for (int i = 0; i < 2 * sides; ++i) {
        const double angle = 2 * pi * (i % sides) / sides;
        solid.add_vertex(m, std::cos(angle), std::sin(angle), i < sides ? -0.4 : 0.4);
    }
    for (int i = 0; i < sides; ++i) {
        bottom.push_back(sides - 1 - i);
        top.push_back(sides + i);
        const int next = (i + 1) % sides, side[4] = {i, next, sides + next, sides + i};
        solid.add_face(4, side);
    }
    solid.add_face(sides, &bottom[0]);
    solid.add_face(sides, &top[0]);
    return solid;
}

/* Rings of triangles between two poles. */
inline Solid sphere(int rings, int around)
{
    const double pi = PI, m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Solid solid;
    for (int ring = 0; ring <= rings; ++ring) {
        const double polar = pi * ring / rings;
        for (int i = 0; i < (ring % rings == 0 ? 1 : around); ++i) {
            const double angle = 2 * pi * (i + 0.5 * ring) / around;
            solid.add_vertex(m, std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar));
        }
    }
    const int last = solid.vertex_count() - 1;
    for (int i = 0; i < around; ++i) {
        const int next = (i + 1) % around, bottom = last - around;
        const int caps[6] = {0, 1 + i, 1 + next, last, bottom + next, bottom + i};
        solid.add_face(3, caps);
        solid.add_face(3, caps + 3);
        for (int ring = 1; ring < rings - 1; ++ring) {
            const int above = 1 + (ring - 1) * around, below = above + around;
            const int two[6] = {above + i, below + i, above + next, below + i, below + next, above + next};
            solid.add_face(3, two);
            solid.add_face(3, two + 3);
        }
    }
    return solid;
}

/* Right prisms over a polygon, from z = -0.5 to 0.5: face 0 is the bottom, face 1 the top, face 2 + i the side from corner i on. */
inline Solid extruded(const double (*polygon)[2], int count)
{
    const double m[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    Solid solid;
    std::vector<int> bottom, top;
    for (int i = 0; i < 2 * count; ++i) {
        solid.add_vertex(m, polygon[i % count][0], polygon[i % count][1], i < count ? -0.5 : 0.5);
    }
    for (int i = 0; i < count; ++i) {
        bottom.push_back(count - 1 - i);
        top.push_back(count + i);
    }
    solid.add_face(count, &bottom[0]);
    solid.add_face(count, &top[0]);
    for (int i = 0; i < count; ++i) {
        const int next = (i + 1) % count, side[4] = {i, next, count + next, count + i};
        solid.add_face(4, side);
    }
    return solid;
}

/* The square from 0 to 2 without that from 1 to 2. */
const double L_POLYGON[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

#endif

/* Files of SWIFT++'s decomposer, which hold an object in two convex pieces. */
#ifndef LEGACY_ROD_H
#define LEGACY_ROD_H

#include <stdint.h>

#include "legacy_test.h"

namespace {

/*
 * The surface of a rod from x = -1 to x = 1, in two cubes that share the square at x = 0: each is closed by two triangles there,
 * which are no faces. Vertex i is number 10 + i of the mesh that was decomposed, face i number 20 + i. As files of SWIFT++'s
 * decomposer.
 */
class Rod {
public:
    bool is_big_endian, is_float, has_maps;

    Rod(bool big_endian, bool floats, bool maps) : is_big_endian(big_endian), is_float(floats), has_maps(maps) {}

    /* The two pieces; beside more or fewer of them the counts are wrong. */
    std::string decomposition(int piece_count = 2) const
    {
        std::ostringstream out;
        begin(out, "Convex_Decomposition");
        out << "vertices 12\nfaces 20\nmap_vids " << (has_maps ? 12 : 0) << "\nmap_fids " << (has_maps ? 20 : 0) << "\npieces " << piece_count
            << "\n";
        vertices(out);
        for (int i = 0; i < 60; ++i) {
            integer(out, corner(i));
        }
        maps(out);
        for (int i = 0; i < 20; ++i) {
            integer(out, i / 10);
        }
        for (int i = 0; i < 2; ++i) {
            integer(out, 10);
        }
        for (int i = 0; i < 2; ++i) {
            integer(out, 2);
        }
        for (int i = 0; i < 20; ++i) {
            integer(out, i);
        }
        for (int i = 60; i < 72; ++i) {
            integer(out, corner(i));
        }
        return out.str();
    }

    /* The two pieces below their hull, which is the surface; or that alone. */
    std::string hulls(int node_count = 3) const
    {
        const bool has_leaves = node_count > 1;
        const int own_faces = has_leaves ? 4 : 0, shared_faces = has_leaves ? 40 : 20;
        std::ostringstream out;
        begin(out, "Convex_Hierarchy");
        out << "vertices 12\nmap_vids " << (has_maps ? 12 : 0) << "\nmap_fids " << (has_maps ? 20 : 0) << "\norig_faces 20\norig_hier_faces "
            << own_faces << "\ntotal_faces " << 20 + own_faces << "\ncopied_faces " << shared_faces << "\nedge_twins 120\nnodes " << node_count
            << "\n";
        /* The height, the centroid, the centre, the radius. */
        integer(out, has_leaves ? 1 : 0);
        for (int i = 0; i < 7; ++i) {
            real(out, i);
        }
        vertices(out);
        maps(out);
        for (int face = 0; face < 20 + own_faces; ++face) {
            for (int i = 3 * face; i < 3 * face + 3; ++i) {
                integer(out, corner(i));
            }
            integer(out, -1 - face);
        }
        for (int i = 0; i < shared_faces; ++i) {
            integer(out, i % 20);
        }
        for (int i = 0; i < 60; ++i) {
            integer(out, i == 7 ? -1 : twin(i));
        }
        for (int i = 0; i < own_faces; ++i) {
            const int face[4] = {20 + i, 0, 4 * i + 1, 4 * (20 + i) + 2};
            for (int k = 0; k < 4; ++k) {
                integer(out, face[k]);
            }
        }
        for (int i = 0; i < 120; ++i) {
            integer(out, twin(i % 60));
        }
        for (int i = 0; i < node_count; ++i) {
            const int root[8] = {20, 0, 0, 20, -1, has_leaves ? 1 : -1, has_leaves ? 2 : -1, 0};
            const int leaf[8] = {10, 10 + 10 * i, 2, 18 + 2 * i, 0, -1, -1, 1};
            node(out, i == 0 ? root : leaf, i % 3);
        }
        return out.str();
    }

private:
    template <class Number> void put(std::ostringstream& out, Number number) const
    {
        char bytes[sizeof number];
        std::memcpy(bytes, &number, sizeof number);
        const uint16_t one = 1;
        char low;
        std::memcpy(&low, &one, 1);
        if (is_big_endian == (low == 1)) {
            std::reverse(bytes, bytes + sizeof number);
        }
        out.write(bytes, sizeof number);
    }

    void real(std::ostringstream& out, double number) const
    {
        if (is_float) {
            put(out, static_cast<float>(number));
        } else {
            put(out, number);
        }
    }

    void integer(std::ostringstream& out, int number) const
    {
        put(out, static_cast<int32_t>(number));
    }

    void begin(std::ostringstream& out, const char* magic) const
    {
        out << '\0' << magic << "\nbinary " << (is_big_endian ? "big_endian" : "little_endian") << "\nreal " << (is_float ? "float" : "double")
            << "\n";
    }

    /* Three rows of four around the x axis: x = -1, 0, 1. */
    void vertices(std::ostringstream& out) const
    {
        for (int v = 0; v < 12; ++v) {
            const int row = v / 4, in_row = v % 4;
            real(out, row - 1);
            real(out, in_row == 1 || in_row == 2 ? 1 : 0);
            real(out, in_row >= 2 ? 1 : 0);
        }
    }

    void maps(std::ostringstream& out) const
    {
        for (int i = 0; has_maps && i < 12; ++i) {
            integer(out, 10 + i);
        }
        for (int i = 0; has_maps && i < 20; ++i) {
            integer(out, 20 + i);
        }
    }

    /* 20 faces of the surface, and 4 between the pieces. */
    static int corner(int i)
    {
        static const int corners[72] = {0, 2, 1, 0, 3,  2, 0,  1,  5, 0, 5, 4, 1, 2, 6, 1,  6, 5,  2, 3, 7, 2,  7,  6,
                                        3, 0, 4, 3, 4,  7, 4,  5,  9, 4, 9, 8, 5, 6, 10, 5, 10, 9, 6, 7, 11, 6, 11, 10,
                                        7, 4, 8, 7, 8, 11, 8, 9, 10, 8, 10, 11, 4, 5, 6, 4, 6, 7, 4, 6, 5, 4, 7, 6};
        return corners[i];
    }

    /* Four times the face across an edge of the surface, and which of that face's edges it is. */
    static int twin(int edge)
    {
        const int tail = corner(edge), head = corner(edge / 3 * 3 + (edge + 1) % 3);
        for (int i = 0; i < 60; ++i) {
            if (corner(i) == head && corner(i / 3 * 3 + (i + 1) % 3) == tail) {
                return 4 * (i / 3) + i % 3;
            }
        }
        return -1;
    }

    /* The centroid, the radius, and a look-up table of 22.5, 11.25 or 5.625 degrees. */
    void node(std::ostringstream& out, const int* members, int kind) const
    {
        for (int i = 0; i < 8; ++i) {
            integer(out, members[i]);
        }
        for (int i = 0; i < 4; ++i) {
            real(out, 0.5 * i);
        }
        integer(out, kind);
        const int sizes[3] = {114, 482, 1986};
        for (int i = 0; i < sizes[kind]; ++i) {
            integer(out, i % 80);
        }
    }
};

} // namespace

#endif

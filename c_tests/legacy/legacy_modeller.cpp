/*
 * A modeller of polyhedra with a broad phase of its own: SWIFT++, bodies of polygons. At every step it deactivates all pairs,
 * activates the candidates and asks with early exit for all that there is about contacts; it takes one contact for each pair for
 * granted.
 */
#include "legacy_test.h"

namespace {

/* A prism over a regular polygon, about the origin; its faces are the sides, then the bottom, then the top. */
struct Prism {
    std::vector<SWIFT_Real> vertices;
    std::vector<int> faces, valences;

    Prism(int corners, double radius, double half_height)
    {
        for (int i = 0; i < 2 * corners; ++i) {
            const double angle = 8 * std::atan(1.0) * (i % corners) / corners;
            vertices.push_back(static_cast<SWIFT_Real>(radius * std::cos(angle)));
            vertices.push_back(static_cast<SWIFT_Real>(radius * std::sin(angle)));
            vertices.push_back(static_cast<SWIFT_Real>(i < corners ? -half_height : half_height));
        }
        for (int i = 0; i < corners; ++i) {
            const int next = (i + 1) % corners, side[4] = {i, next, corners + next, corners + i};
            faces.insert(faces.end(), side, side + 4);
            valences.push_back(4);
        }
        for (int i = 0; i < corners; ++i) {
            faces.push_back(corners - 1 - i);
        }
        for (int i = 0; i < corners; ++i) {
            faces.push_back(corners + i);
        }
        valences.push_back(corners);
        valences.push_back(corners);
    }

    bool add(SWIFT_Scene& scene, int& id) const
    {
        return scene.Add_Convex_Object(&vertices[0], &faces[0], static_cast<int>(vertices.size() / 3),
                                       static_cast<int>(valences.size()), id, DEFAULT_FIXED, DEFAULT_ORIENTATION,
                                       DEFAULT_TRANSLATION, DEFAULT_SCALE, DEFAULT_BOX_SETTING, DEFAULT_BOX_ENLARGE_REL,
                                       DEFAULT_BOX_ENLARGE_ABS, &valences[0], DEFAULT_CUBE_ASPECT_RATIO);
    }
};

template <class Number> double length(const Number* from, const Number* to)
{
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        sum += (to[axis] - from[axis]) * (to[axis] - from[axis]);
    }
    return std::sqrt(sum);
}

} // namespace

int main()
{
    /* Prisms with a corner on the +x axis, and one on the -x axis as they are even. */
    const Prism six(6, 1, 0.5), eight(8, 1, 0.75);
    SWIFT_Scene scene(false, false);
    int ids[4];
    for (int i = 0; i < 4; ++i) {
        CHECK((i % 2 == 0 ? six : eight).add(scene, ids[i]) && ids[i] == i);
    }
    /* The candidates of each step, and how far apart they are: corner edges look at each other. */
    const double xs[4] = {0, 3, 3, 6}, zs[4] = {0, 0, 4, 0};
    for (int i = 0; i < 4; ++i) {
        move_to(scene, i, xs[i], 0, zs[i]);
    }
    const int candidates[2][2] = {{0, 1}, {2, 1}};
    const double distances[2] = {1, 2.75};
    for (int step = 0; step < 3; ++step) {
        scene.Deactivate();
        for (int c = 0; c < 2; ++c) {
            scene.Activate(candidates[c][0], candidates[c][1]);
        }
        int pairs, *oids, *counts, *types, *feature_ids;
        SWIFT_Real *distance, *points, *normals;
        const bool intersects = scene.Query_Contact_Determination(true, SWIFT_INFINITY, pairs, &oids, &counts, &distance, &points,
                                                                  &normals, &types, &feature_ids);
        CHECK(!intersects && pairs == 2);
        const int* id = feature_ids;
        for (int k = 0; k < pairs; ++k) {
            CHECK(oids[2 * k] <= oids[2 * k + 1]);
            CHECK(counts[k] == 1);
            CHECK(is_near(distance[k], distances[k]));
            double p[2][3];
            for (int side = 0; side < 2; ++side) {
                const int i = oids[2 * k + side];
                const SWIFT_Real T[3] = {static_cast<SWIFT_Real>(xs[i]), 0, static_cast<SWIFT_Real>(zs[i])};
                place_point(DEFAULT_ORIENTATION, T, points + 6 * k + 3 * side, p[side]);
                /* The stream of ids is walked by the kinds; a feature holds the point. */
                const Prism& prism = i % 2 == 0 ? six : eight;
                const int kind = types[2 * k + side];
                CHECK(kind == SWIFT_VERTEX || kind == SWIFT_EDGE || kind == SWIFT_FACE);
                if (kind == SWIFT_VERTEX) {
                    for (int axis = 0; axis < 3; ++axis) {
                        CHECK(is_near(points[6 * k + 3 * side + axis], prism.vertices[static_cast<std::size_t>(3 * id[0] + axis)]));
                    }
                } else if (kind == SWIFT_EDGE) {
                    for (int end = 0; end < 2; ++end) {
                        CHECK(id[end] >= 0 && static_cast<std::size_t>(3 * id[end]) < prism.vertices.size());
                    }
                    const SWIFT_Real* point = points + 6 * k + 3 * side;
                    const SWIFT_Real* a = &prism.vertices[static_cast<std::size_t>(3 * id[0])];
                    const SWIFT_Real* b = &prism.vertices[static_cast<std::size_t>(3 * id[1])];
                    CHECK(is_near(length(a, point) + length(point, b), length(a, b)));
                } else {
                    /* Where a face is near it is the bottom or the top. */
                    CHECK(k == 1 && id[0] == static_cast<int>(prism.valences.size()) - (side == 0 ? 1 : 2));
                }
                id += kind == SWIFT_EDGE ? 2 : 1;
            }
            CHECK(is_near(length(p[0], p[1]), distance[k]));
        }
        CHECK(oids[0] == 0 && oids[1] == 1 && oids[2] == 1 && oids[3] == 2);
        CHECK(is_near3(normals, -1, 0, 0) && is_near3(normals + 3, 0, 0, -1));
        /*
         * The first pair meets along two vertical edges, the second one at parallel faces: beside a face is a vertex, all the
         * same.
         */
        CHECK(types[0] != SWIFT_FACE && types[1] != SWIFT_FACE);
        CHECK(types[2] != SWIFT_FACE || types[3] == SWIFT_VERTEX);
        CHECK(types[3] != SWIFT_FACE || types[2] == SWIFT_VERTEX);
    }

    /* Early exit: a collision, and nothing is listed. */
    move_to(scene, 1, 1.5, 0, 0);
    int pairs, *oids, *counts, *types, *feature_ids;
    SWIFT_Real *distance, *points, *normals;
    CHECK(scene.Query_Contact_Determination(true, SWIFT_INFINITY, pairs, &oids, &counts, &distance, &points, &normals, &types,
                                            &feature_ids));
    CHECK(pairs == 0);
    /* Without: -1, and one place in every array, four of feature ids. */
    CHECK(scene.Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &oids, &counts, &distance, &points, &normals, &types,
                                            &feature_ids));
    CHECK(pairs == 2 && counts[0] == -1 && counts[1] == 1 && is_same(distance[0], -1) && distance[1] > 0);
    const int needed = (types[0] == SWIFT_EDGE ? 2 : 1) + (types[1] == SWIFT_EDGE ? 2 : 1);
    for (int i = needed; i < 4; ++i) {
        CHECK(feature_ids[i] == -1);
    }
    CHECK(feature_ids[4] >= 0 && oids[2] == 1 && oids[3] == 2);
    return check_report("legacy_modeller");
}

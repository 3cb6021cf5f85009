/*
 * An actor among boxes that slides on their grid: SWIFT++ with the broad phase, one object active, only the verdict is asked
 * for. And the grid of 15,625 placements of two boxes, with faces, edges and corners that align: each answer is the exact one.
 */
#include "legacy_test.h"

namespace {

double gap(double offset, double sum_of_halves)
{
    return std::max(0.0, std::fabs(offset) - sum_of_halves);
}

/* Vertex and vertex, vertex and edge, vertex and face, edge and edge, of boxes: also where they are deep in each other. */
bool are_known_features(const int* types, const int* ids)
{
    for (int side = 0; side < 2; ++side) {
        const int type = types[side];
        if (type != SWIFT_VERTEX && type != SWIFT_EDGE && (type != SWIFT_FACE || types[1 - side] != SWIFT_VERTEX)) {
            return false;
        }
        for (int i = 0; i < (type == SWIFT_EDGE ? 2 : 1); ++i, ++ids) {
            if (*ids < 0 || *ids >= (type == SWIFT_FACE ? 12 : 8)) {
                return false;
            }
        }
    }
    return true;
}

/* 25 places along each axis, a quarter apart: the boxes touch at 1.5, 1.25 and 1 and overlap below. */
void grid(bool has_broad_phase)
{
    const BoxMesh box(1, 0.75, 0.5), small(0.5, 0.5, 0.5);
    SWIFT_Scene scene(has_broad_phase, false);
    int first, second;
    CHECK(box.add(scene, first) && small.add(scene, second));
    int placements = 0, touching = 0, wrong = 0;
    for (int x = -12; x <= 12; ++x) {
        for (int y = -12; y <= 12; ++y) {
            for (int z = -12; z <= 12; ++z, ++placements) {
                const double at[3] = {0.25 * x, 0.25 * y, 0.25 * z};
                move_to(scene, second, at[0], at[1], at[2]);
                const double gaps[3] = {gap(at[0], 1.5), gap(at[1], 1.25), gap(at[2], 1)};
                const double truth = std::sqrt(gaps[0] * gaps[0] + gaps[1] * gaps[1] + gaps[2] * gaps[2]);
                const bool intersects = truth <= 0;
                touching += intersects && (is_same(std::fabs(at[0]), 1.5) || is_same(std::fabs(at[1]), 1.25) ||
                                           is_same(std::fabs(at[2]), 1));
                int pairs, *ids;
                SWIFT_Real* distance;
                bool is_right = scene.Query_Intersection(true, pairs, &ids) == intersects && pairs == 0;
                is_right = is_right && scene.Query_Exact_Distance(false, 4, pairs, &ids, &distance) == intersects;
                if (truth <= 4) {
                    is_right = is_right && pairs == 1 && is_near(distance[0], intersects ? -1 : truth);
                } else {
                    is_right = is_right && pairs == 0;
                }
                /* The normal is right, too, where only one axis parts them; and unit where they touch. */
                SWIFT_Real *points = NULL, *normals = NULL;
                int *pids, *types = NULL, *feature_ids = NULL;
                is_right = is_right && scene.Query_Contact_Determination(false, 4, pairs, &ids, NO_DISTANCES, &points, &normals,
                                                                         &pids, &types, &feature_ids) == intersects;
                is_right = is_right && (pairs == 0 || are_known_features(types, feature_ids));
                for (int axis = 0; axis < 3 && truth <= 4 && !intersects; ++axis) {
                    is_right = is_right && is_near(normals[axis] * truth, at[axis] > 0 ? -gaps[axis] : gaps[axis]);
                }
                wrong += is_right ? 0 : 1;
            }
        }
    }
    CHECK(placements == 15625);
    CHECK(touching == 13 * 11 * 9 - 11 * 9 * 7);
    CHECK(wrong == 0);
}

void actor()
{
    const BoxMesh box(0.5, 0.5, 0.5);
    SWIFT_Scene* scene = new SWIFT_Scene(true, false);
    for (int i = 0; i < 144; ++i) {
        int id = -1;
        CHECK(scene->Add_Convex_Object(&box.vertices[0], &box.triangles[0], 8, 12, id, false));
        move_to(*scene, id, i % 12 * 2, i / 12 * 2, 0);
    }
    int actor_id = -1;
    CHECK(box.add(*scene, actor_id) && actor_id == 144);
    scene->Deactivate();
    scene->Activate(actor_id);
    /* Along a row of boxes in steps of a quarter: it meets one unless it is just between two of them, touching included. */
    for (int step = 0; step <= 88; ++step) {
        for (int lane = 0; lane <= 4; ++lane) {
            const double x = 0.25 * step, y = 0.25 * lane;
            move_to(*scene, actor_id, x, y, 0);
            const double from_box = std::fabs(x - 2 * std::floor(x / 2 + 0.5));
            const double from_row = std::fabs(y - 2 * std::floor(y / 2 + 0.5));
            int pairs, *ids;
            CHECK(scene->Query_Intersection(true, pairs, &ids) == (from_box <= 1 && from_row <= 1));
            CHECK(pairs == 0);
        }
    }
    move_to(*scene, actor_id, 4, 4, 0.75);
    int pairs, *ids;
    CHECK(scene->Query_Intersection(false, pairs, &ids));
    CHECK(pairs == 1 && ids[0] == 26 && ids[1] == actor_id);
    SWIFT_Real* distances;
    CHECK(scene->Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distances));
    CHECK(pairs >= 1 && pairs < 145);
    delete scene;
}

} // namespace

int main()
{
    grid(false);
    grid(true);
    actor();
    return check_report("legacy_actor");
}

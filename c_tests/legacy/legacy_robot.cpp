/*
 * A robot's collision interface: SWIFT++ without the broad phase. Index arrays of unsigned numbers, pairs left out by name, bodies
 * that are removed and added, an intersecting pair that takes one place in every array.
 */
#include "legacy_test.h"
/* Such programs do it: SWIFT 1.x defines both. */
#undef min
#undef max
#include <algorithm>

class SWIFT_Scene;

namespace {

struct Body {
    std::vector<SWIFT_Real> vertices;
    std::vector<unsigned> triangles;
    int id;
};

Body box(double x, double y, double z)
{
    const BoxMesh mesh(x, y, z);
    Body body;
    body.vertices.assign(mesh.vertices, mesh.vertices + 24);
    body.triangles.assign(mesh.triangles, mesh.triangles + 36);
    body.id = -1;
    return body;
}

void add(SWIFT_Scene* scene, Body& body)
{
    const bool is_added = scene->Add_Convex_Object(&body.vertices[0], reinterpret_cast<int*>(&body.triangles[0]),
                                                   static_cast<int>(body.vertices.size() / 3),
                                                   static_cast<int>(body.triangles.size() / 3), body.id, false, DEFAULT_ORIENTATION,
                                                   DEFAULT_TRANSLATION, DEFAULT_SCALE, DEFAULT_BOX_SETTING, DEFAULT_BOX_ENLARGE_REL,
                                                   2.);
    CHECK(is_added);
}

/* What the interface keeps of a contact: the points in the world. */
struct Proxy {
    int a, b;
    double distance;
    double point_a[3], point_b[3], normal[3];
};

std::vector<Proxy> contacts(SWIFT_Scene* scene, const std::vector<Rotation>& turns, const std::vector<SWIFT_Real>& places)
{
    bool has_cycle = false;
    int pairs, *ids = NULL, *counts = NULL;
    SWIFT_Real *distances = NULL, *points = NULL, *normals = NULL;
    try {
        scene->Query_Contact_Determination(false, SWIFT_INFINITY, pairs, &ids, &counts, &distances, &points, &normals);
    } catch (const char*) {
        has_cycle = true;
    }
    CHECK(!has_cycle);
    std::vector<Proxy> proxies;
    int at = 0;
    for (int k = 0; k < pairs; ++k) {
        const int places_taken = counts[k] == -1 ? 1 : counts[k];
        for (int contact = 0; contact < places_taken; ++contact, ++at) {
            Proxy proxy;
            proxy.a = ids[2 * k];
            proxy.b = ids[2 * k + 1];
            proxy.distance = distances[at];
            const std::size_t a = static_cast<std::size_t>(proxy.a), b = static_cast<std::size_t>(proxy.b);
            place_point(turns[a].m, &places[3 * a], points + 6 * at, proxy.point_a);
            place_point(turns[b].m, &places[3 * b], points + 6 * at + 3, proxy.point_b);
            std::copy(normals + 3 * at, normals + 3 * at + 3, proxy.normal);
            proxies.push_back(proxy);
        }
    }
    return proxies;
}

} // namespace

int main()
{
    SWIFT_Scene* scene = new SWIFT_Scene(false, true);
    std::vector<Body> bodies;
    for (int i = 0; i < 4; ++i) {
        bodies.push_back(box(0.5, 0.5, 0.5));
        add(scene, bodies.back());
        CHECK(bodies.back().id == i);
    }
    /* In a row along x, 0 and 1 overlap, 3 is turned by an eighth about z: its edge looks towards 2. */
    std::vector<Rotation> turns(4, Rotation(2, 0));
    turns[3] = Rotation(2, std::atan(1.0));
    const double xs[4] = {0, 0.75, 3, 6};
    std::vector<SWIFT_Real> places(12, 0);
    for (std::size_t i = 0; i < 4; ++i) {
        places[3 * i] = static_cast<SWIFT_Real>(xs[i]);
        scene->Set_Object_Transformation(bodies[i].id, turns[i].m, &places[3 * i]);
    }

    std::vector<Proxy> proxies = contacts(scene, turns, places);
    CHECK(proxies.size() == 6);
    const int order[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
    const double half_diagonal = std::sqrt(0.5);
    const double distances[6] = {-1, 2, 1.25, 5.5 - half_diagonal, 4.75 - half_diagonal, 2.5 - half_diagonal};
    for (std::size_t k = 0; k < proxies.size(); ++k) {
        const Proxy& proxy = proxies[k];
        CHECK(proxy.a == order[k][0] && proxy.b == order[k][1]);
        CHECK(is_near(proxy.distance, distances[k]));
        const double length = std::sqrt(proxy.normal[0] * proxy.normal[0] + proxy.normal[1] * proxy.normal[1] +
                                        proxy.normal[2] * proxy.normal[2]);
        CHECK(is_near(length, 1));
        if (k > 0) {
            /* From the second object to the first, along -x; the points are that far apart. */
            CHECK(is_near(proxy.normal[0], -1));
            CHECK(is_near(proxy.point_b[0] - proxy.point_a[0], distances[k]));
            CHECK(is_near(proxy.point_b[1], proxy.point_a[1]) && is_near(proxy.point_b[2], proxy.point_a[2]));
        }
    }

    /* Pairs that are left out, without the broad phase, also after they were asked for. */
    scene->Deactivate(0, 1);
    scene->Deactivate(bodies[3].id);
    proxies = contacts(scene, turns, places);
    CHECK(proxies.size() == 2 && proxies[0].b == 2 && proxies[1].a == 1);
    scene->Activate(3);
    scene->Activate(1, 0);
    scene->Deactivate(0, 1);
    CHECK(contacts(scene, turns, places).size() == 5);

    int pairs, *ids = NULL;
    SWIFT_Real* distance = NULL;
    CHECK(!scene->Query_Exact_Distance(false, SWIFT_INFINITY, pairs, &ids, &distance));
    CHECK(pairs == 5 && ids[0] == 0 && ids[1] == 2 && is_near(distance[0], 2));

    /* The latest form of the interface asks which pairs are closer than a margin. */
    bool is_any_near = false;
    try {
        is_any_near = scene->Query_Tolerance_Verification(false, static_cast<SWIFT_Real>(1.5), pairs, &ids);
    } catch (std::pair<int, int>) {
        is_any_near = false;
    }
    CHECK(is_any_near && pairs == 1 && ids[0] == 1 && ids[1] == 2);

    /* A body is changed: its id is used again, the lower id still comes first, all its pairs are active. */
    scene->Delete_Object(bodies[1].id);
    Body other = box(0.25, 0.25, 0.25);
    add(scene, other);
    CHECK(other.id == 1);
    places[3] = 0, places[4] = 2;
    scene->Set_Object_Transformation(1, turns[1].m, &places[3]);
    proxies = contacts(scene, turns, places);
    CHECK(proxies.size() == 6);
    /* By the one that was created later: 0-2, 0-3, 2-3, and then those with the new 1. */
    const int later[6][2] = {{0, 2}, {0, 3}, {2, 3}, {0, 1}, {1, 2}, {1, 3}};
    for (std::size_t k = 0; k < proxies.size(); ++k) {
        CHECK(proxies[k].a == later[k][0] && proxies[k].b == later[k][1]);
    }
    CHECK(is_near(proxies[3].distance, 1.25) && is_near(proxies[3].normal[1], -1));
    CHECK(is_near(proxies[3].point_a[1], 0.5) && is_near(proxies[3].point_b[1], 1.75));
    CHECK(is_near(proxies[4].point_a[0], 0.25) && is_near(proxies[4].point_b[0], 2.5) && proxies[4].normal[0] < -0.5);
    delete scene;
    return check_report("legacy_robot");
}

// coal's queries of convex bodies, with its guess and support hints handed back in: the distance by GJK, the verdict by a GJK that
// stops at the first direction that separates, the depth by EPA.

#include <limits>
#include <memory>
#include <vector>

#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

extern "C" {
#include "peer.h"
}

using Convex = coal::Convex<coal::Triangle>;

struct peer {
    std::unique_ptr<coal::ShapeBase> shapes[2];
    std::unique_ptr<coal::ComputeDistance> distance;
    std::unique_ptr<coal::ComputeCollision> collision;
    coal::DistanceRequest of_distance, of_depth;
    coal::CollisionRequest of_verdict;
    coal::DistanceResult result;
    coal::CollisionResult verdict;
    std::vector<coal::Transform3s> poses;
};

static coal::Transform3s transform(const double *m)
{
    coal::Matrix3s rotation;
    rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    return coal::Transform3s(rotation, coal::Vec3s(m[3], m[7], m[11]));
}

static coal::ShapeBase *convex(const peer_mesh &mesh)
{
    auto points = std::make_shared<std::vector<coal::Vec3s>>();
    for (size_t i = 0; i < mesh.vertex_count; ++i) {
        points->emplace_back(mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]);
    }
    auto triangles = std::make_shared<std::vector<coal::Triangle>>();
    for (size_t i = 0; i < mesh.triangle_count; ++i) {
        const unsigned *corners = mesh.corners + 3 * i;
        triangles->emplace_back(corners[0], corners[1], corners[2]);
    }
    return new Convex(points, static_cast<unsigned>(mesh.vertex_count), triangles, static_cast<unsigned>(mesh.triangle_count));
}

static void forget(coal::QueryRequest &request)
{
    request.gjk_initial_guess = coal::GJKInitialGuess::CachedGuess;
    request.cached_gjk_guess = coal::Vec3s(1, 0, 0);
    request.cached_support_func_guess.setZero();
}

// The signed distance and, in the world, along what; the guess is kept.
static double ask(peer *peer, size_t i, coal::DistanceRequest &request, double *normal)
{
    try {
        peer->result.clear();
        const double distance = (*peer->distance)(peer->poses[2 * i], peer->poses[2 * i + 1], request, peer->result);
        request.updateGuess(peer->result);
        Eigen::Map<coal::Vec3s> said(normal);
        said = peer->result.normal;
        return distance;
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}

extern "C" {

static peer *create(const peer_mesh *meshes, double tolerance, coal::ShapeBase *(*shape)(const peer_mesh &))
{
    try {
        std::unique_ptr<peer> made(new peer);
        for (int k = 0; k < 2; ++k) {
            made->shapes[k].reset(shape(meshes[k]));
        }
        made->distance.reset(new coal::ComputeDistance(made->shapes[0].get(), made->shapes[1].get()));
        made->collision.reset(new coal::ComputeCollision(made->shapes[0].get(), made->shapes[1].get()));
        made->of_distance.enable_signed_distance = false;
        made->of_distance.gjk_tolerance = tolerance;
        made->of_depth.enable_signed_distance = true;
        made->of_depth.epa_tolerance = tolerance;
        made->of_verdict.enable_contact = false;
        made->of_verdict.distance_upper_bound = 0;
        made->of_verdict.gjk_tolerance = tolerance;
        return made.release();
    } catch (...) {
        return nullptr;
    }
}

peer *coal_peer_create(const peer_mesh *meshes, double tolerance)
{
    return create(meshes, tolerance, convex);
}

// Of a point a sphere, of a segment along z a capsule, of eight corners along the axes a box.
peer *coal_round_create(const peer_mesh *meshes, double tolerance)
{
    return create(meshes, tolerance, [](const peer_mesh &mesh) -> coal::ShapeBase * {
        const double *last = mesh.vertices + 3 * (mesh.vertex_count - 1);
        switch (mesh.vertex_count) {
        case 1:
            return new coal::Sphere(mesh.radius);
        case 2:
            return new coal::Capsule(mesh.radius, 2 * last[2]);
        case 8: {
            coal::Box *box = new coal::Box(2 * last[0], 2 * last[1], 2 * last[2]);
            box->setSweptSphereRadius(mesh.radius);
            return box;
        }
        default:
            return convex(mesh);
        }
    });
}

void coal_peer_free(peer *peer)
{
    delete peer;
}

void coal_peer_load(peer *peer, const double *poses, size_t count)
{
    peer->poses.clear();
    for (size_t i = 0; i < 2 * count; ++i) {
        peer->poses.push_back(transform(poses + 12 * i));
    }
}

void coal_peer_forget(peer *peer)
{
    forget(peer->of_distance);
    forget(peer->of_depth);
    forget(peer->of_verdict);
}

double coal_distance(peer *peer, size_t i, double *normal)
{
    const double distance = ask(peer, i, peer->of_distance, normal);
    return distance < 0 ? 0 : distance;
}

double coal_depth(peer *peer, size_t i, double *normal)
{
    const double distance = ask(peer, i, peer->of_depth, normal);
    return distance < 0 ? -distance : distance >= 0 ? 0 : distance;
}

double coal_verdict(peer *peer, size_t i, double *)
{
    try {
        peer->verdict.clear();
        const bool intersect =
            (*peer->collision)(peer->poses[2 * i], peer->poses[2 * i + 1], peer->of_verdict, peer->verdict) > 0;
        peer->of_verdict.updateGuess(peer->verdict);
        return intersect ? 0 : std::numeric_limits<double>::infinity();
    } catch (...) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}
}

// What a library in C++ that is asked about two equal bodies of many pieces is behind, for native.rs.
#ifndef COMPARE_COMPOUND_PEER_H
#define COMPARE_COMPOUND_PEER_H

#include "../peers/peer.h"

#include <limits>

struct compound_scene {
    const peer_mesh *pieces;
    size_t piece_count;
    peer_mesh surface;   // of their union, without the walls between them
    const double *poses; // row-major [R|T] of both bodies, one after the other
    size_t pose_count;
    int asks_distance; // or else the verdict
};

// The functions of a class that is made of a scene. Its ask(k) is the distance at pose k, or 0 of bodies that meet and 1 of others.
// No exception leaves them.
#define COMPOUND_PEER(name, Peer)                                                               \
    extern "C" void *name##_create(const compound_scene *scene)                                 \
    {                                                                                           \
        try {                                                                                   \
            return new Peer(*scene);                                                            \
        } catch (...) {                                                                         \
            return nullptr;                                                                     \
        }                                                                                       \
    }                                                                                           \
    extern "C" double name##_ask(void *peer, size_t k)                                          \
    {                                                                                           \
        try {                                                                                   \
            return static_cast<Peer *>(peer)->ask(k);                                           \
        } catch (...) {                                                                         \
            return std::numeric_limits<double>::quiet_NaN();                                    \
        }                                                                                       \
    }                                                                                           \
    extern "C" void name##_free(void *peer)                                                     \
    {                                                                                           \
        delete static_cast<Peer *>(peer);                                                       \
    }

#endif

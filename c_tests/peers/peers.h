/* Other libraries ("peers") behind the same few functions. peer_libccd.c and peer_fcl.cpp each define the list below; a
 * program links one of them. */
#ifndef PEERS_H
#define PEERS_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a peer said of a pose, or what became of it. */
enum peer_outcome { PEER_CRASHED, PEER_ENDLESS, PEER_THREW, PEER_SEPARATED, PEER_INTERSECTING };

struct peer_answer {
    enum peer_outcome outcome;
    double distance;       /* NaN: not said */
    double point_distance; /* the distance between its nearest points; NaN: not said */
};

/* One way of using a peer. */
struct peer {
    const char *name;
    const char *option; /* the name on command lines */
    double tolerance;   /* the peer's default; 0: it has none */
    int says_distance;  /* 0: verdicts only */
    /* What the peer makes of a body, kept in body->of_peer; null when it refuses the body. */
    void *(*create)(const struct body *body);
    void (*destroy)(void *of_peer);
    void (*query)(const struct peer *peer, const struct body *body1, const double pose1[12], const struct body *body2,
                  const double pose2[12], struct peer_answer *answer);
};

extern const struct peer all_peers[];
extern const size_t all_peer_count;

#ifdef __cplusplus
}
#endif

#endif

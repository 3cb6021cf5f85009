/* Compares the library with other ones ("peers") on all scenes. Every peer runs in a child process, so that it may crash or
 * never end; the next child goes on behind the pose that did it. Where a peer and the library differ, the exact oracle
 * decides. */
#ifndef COMPARISON_H
#define COMPARISON_H

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

struct peer {
    const char *name;
    /* What the peer makes of a body, kept in body->of_peer; null functions when it needs nothing. */
    void *(*create)(const struct body *body);
    void (*destroy)(void *of_peer);
    void (*query)(const struct body *body1, const double pose1[12], const struct body *body2, const double pose2[12],
                  struct peer_answer *answer);
};

/* Runs everything and prints a table; the exit status of the program. `oracle`: the path of the oracle program. */
int compare(const char *program, const char *oracle, const struct peer *peers, size_t peer_count);

#ifdef __cplusplus
}
#endif

#endif

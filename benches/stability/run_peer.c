/* Runs one of the peers that this program is linked with:  run_... PEER[=TOLERANCE] A B POSES */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "peers.h"
#include "runner.h"

/* The peer of that name with that tolerance; false when it is unknown. */
static bool find_peer(const char *argument, struct peer *peer)
{
    const size_t length = strcspn(argument, "=");
    for (size_t p = 0; p < all_peer_count; ++p) {
        *peer = all_peers[p];
        if (strlen(peer->option) == length && strncmp(peer->option, argument, length) == 0) {
            if (argument[length])
                peer->tolerance = strtod(argument + length + 1, NULL);
            return true;
        }
    }
    return false;
}

static void answer_all(const struct peer *peer, const struct run *run)
{
    for (size_t i = 0; i < run->poses.count; ++i) {
        const struct pose_pair *pose = &run->poses.pairs[i];
        struct peer_answer answer;
        peer->query(peer, &run->bodies[0], pose->first, &run->bodies[1], pose->second, &answer);
        if (answer.outcome == PEER_INTERSECTING)
            puts("intersecting");
        else if (answer.outcome != PEER_SEPARATED)
            puts("failed");
        else if (peer->says_distance)
            printf("separated %.17g\n", answer.distance);
        else
            puts("separated");
        fflush(stdout);
    }
}

static void print_ready(const struct peer *peer)
{
    printf("ready %s", peer->name);
    if (peer->tolerance > 0)
        printf(", tolerance %g", peer->tolerance);
    putchar('\n');
    fflush(stdout);
}

int main(int argc, char **argv)
{
    struct peer peer;
    if (argc != 5 || !find_peer(argv[1], &peer)) {
        fprintf(stderr, "usage: %s PEER[=TOLERANCE] A B POSES, where PEER is one of", argv[0]);
        for (size_t p = 0; p < all_peer_count; ++p)
            fprintf(stderr, " %s", all_peers[p].option);
        fputc('\n', stderr);
        return RUN_MISUSED;
    }
    struct run run;
    int result = RUN_REFUSED;
    if (run_load(argv + 2, &run)) {
        bool created = true;
        for (int k = 0; k < 2; ++k)
            created &= (run.bodies[k].of_peer = peer.create(&run.bodies[k])) != NULL;
        if (created) {
            print_ready(&peer);
            answer_all(&peer, &run);
            result = RUN_GOOD;
        }
        for (int k = 0; k < 2; ++k)
            peer.destroy(run.bodies[k].of_peer);
    }
    run_free(&run);
    return result;
}

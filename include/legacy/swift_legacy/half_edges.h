/* The half-edges of triangles: which triangle has the edge from one vertex to another. */
#ifndef SWIFT_LEGACY_HALF_EDGES_H
#define SWIFT_LEGACY_HALF_EDGES_H

#include <map>
#include <utility>
#include <vector>

namespace swift_legacy {

class HalfEdges {
public:
    enum { NONE = -1 };

    /* `place` is what `find` gives. False where there is one already from this tail to this head. */
    bool add(int tail, int head, int place)
    {
        return places_.insert(std::make_pair(std::make_pair(tail, head), place)).second;
    }

    /* NONE where there is no such half-edge. */
    int find(int tail, int head) const
    {
        const Places::const_iterator found = places_.find(std::make_pair(tail, head));
        return found == places_.end() ? static_cast<int>(NONE) : found->second;
    }

    /* One that begins at a vertex; NONE where none does. */
    int find_from(int tail) const
    {
        const Places::const_iterator found = places_.lower_bound(std::make_pair(tail, -1));
        return found == places_.end() || found->first.first != tail ? static_cast<int>(NONE) : found->second;
    }

    /* Tail and head of all that lack their twin, as the twin would have them. */
    std::vector<std::pair<int, int> > missing_twins() const
    {
        std::vector<std::pair<int, int> > missing;
        for (Places::const_iterator edge = places_.begin(); edge != places_.end(); ++edge) {
            if (find(edge->first.second, edge->first.first) == NONE) {
                missing.push_back(std::make_pair(edge->first.second, edge->first.first));
            }
        }
        return missing;
    }

private:
    typedef std::map<std::pair<int, int>, int> Places;
    Places places_;
};

} // namespace swift_legacy

#endif

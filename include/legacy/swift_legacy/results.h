/* What the last query found, in the order and the arrays of old. */
#ifndef SWIFT_LEGACY_RESULTS_H
#define SWIFT_LEGACY_RESULTS_H

#include "defaults.h"
#include "objects.h"

namespace swift_legacy {

/* What the ids of an intersecting pair take: what its features need, as in SWIFT 1.x, or four places, as in SWIFT++. */
enum IntersectingFeatures { INTERSECTING_TAKE_NEEDED, INTERSECTING_TAKE_FOUR };

/* The nearest feature of one object. */
class FeatureSide {
public:
    FeatureSide(const Geometry& geometry, const swiftprox_feature& feature, const double* point)
        : geometry_(&geometry), point_(point), type_(SWIFT_VERTEX)
    {
        ids_[0] = feature.ids[0];
        ids_[1] = feature.ids[1];
        if (feature.kind == SWIFTPROX_FEATURE_KIND_EDGE) {
            type_ = SWIFT_EDGE;
        } else if (feature.kind == SWIFTPROX_FEATURE_KIND_FACE) {
            type_ = SWIFT_FACE;
        }
    }

    int type() const
    {
        return type_;
    }

    /* The corner nearest to the point takes the feature's place. */
    void become_vertex()
    {
        if (type_ == SWIFT_EDGE) {
            const bool is_second = geometry_->square_distance(ids_[1], point_) < geometry_->square_distance(ids_[0], point_);
            ids_[0] = ids_[is_second ? 1 : 0];
        } else if (type_ == SWIFT_FACE) {
            ids_[0] = geometry_->nearest_corner(ids_[0], point_);
        }
        type_ = SWIFT_VERTEX;
    }

    void append_ids(std::vector<int>& out) const
    {
        if (type_ == SWIFT_FACE) {
            out.push_back(geometry_->face_label(ids_[0]));
        } else if (type_ == SWIFT_VERTEX) {
            out.push_back(geometry_->vertex_label(ids_[0]));
        } else {
#if defined(SWIFT_ONLY_TRIS) && defined(SWIFT_REPORT_EDGE_IDS)
            out.push_back(geometry_->edge_id(ids_[0], ids_[1]));
#else
            out.push_back(geometry_->vertex_label(ids_[0]));
            out.push_back(geometry_->vertex_label(ids_[1]));
#endif
        }
    }

private:
    const Geometry* geometry_;
    const double* point_;
    int type_;
    uint32_t ids_[2];
};

struct FeaturePair {
    FeatureSide sides[2];

    /*
     * To a combination that old programs know: beside a face there is a vertex. swiftprox answers others where bodies intersect,
     * and where its exact arithmetic decides.
     */
    void reduce()
    {
        if (sides[1].type() == SWIFT_FACE) {
            sides[0].become_vertex();
        } else if (sides[0].type() == SWIFT_FACE) {
            sides[1].become_vertex();
        }
    }
};

typedef swiftprox_pair_result Found;

inline bool is_intersecting(const Found& found)
{
    return found.answer.outcome == SWIFTPROX_OUTCOME_INTERSECTING;
}

/* Whether the lower id is that of object 2. */
inline bool is_swapped(const Found& found)
{
    return found.user_data1 > found.user_data2;
}

/* A found pair, with what all queries want of it: where there are many, reading them again takes as long as finding them. */
struct Entry {
    const Found* found;
    int lower_id;
    int higher_id;
    SWIFT_Real distance; /* -1 where they intersect */

    Entry() : found(NULL), lower_id(0), higher_id(0), distance(0) {}

    explicit Entry(const Found& pair)
        : found(&pair), lower_id(static_cast<int>(pair.user_data1)), higher_id(static_cast<int>(pair.user_data2)),
          distance(is_intersecting(pair) ? static_cast<SWIFT_Real>(-1) : static_cast<SWIFT_Real>(pair.answer.distance))
    {
        if (lower_id > higher_id) {
            std::swap(lower_id, higher_id);
        }
    }
};

class Results {
public:
    Results() : is_early_(false) {}

    void clear()
    {
        listed_.clear();
    }

    /*
     * Takes what a query lists, by object 1, into the order by the object that was created later. The objects are ranked. Of a
     * query that ended early the pair that ended it is taken: it stands in the arrays, and is not counted.
     */
    void take(const swiftprox_scene_answer& answer, const Objects& objects)
    {
        is_early_ = answer.found != NULL;
        if (is_early_) {
            listed_.assign(1, Entry(*answer.found));
            return;
        }
        listed_.resize(answer.count);
        if (answer.count == 1) {
            listed_[0] = Entry(answer.pairs[0]);
            return;
        }
        ranks_.resize(answer.count);
        int before = 0;
        bool is_in_order = true;
        for (std::size_t i = 0; i < answer.count; ++i) {
            listed_[i] = Entry(answer.pairs[i]);
            ranks_[i] = objects.rank_of(static_cast<int>(answer.pairs[i].user_data2));
            is_in_order = is_in_order && before <= ranks_[i];
            before = ranks_[i];
        }
        if (!is_in_order) {
            sort_by_rank(objects.created().size());
        }
    }

    std::vector<Entry>& listed()
    {
        return listed_;
    }

    int count() const
    {
        return is_early_ ? 0 : static_cast<int>(listed_.size());
    }

    /* Entry k of the distances; null where there is none. */
    const Found* found(int k) const
    {
        const bool is_there = !is_early_ && k >= 0 && static_cast<std::size_t>(k) < listed_.size();
        return is_there ? listed_[static_cast<std::size_t>(k)].found : NULL;
    }

    int* write_ids()
    {
        int* ids = room_in(ids_, 2 * listed_.size());
        for (std::size_t k = 0; k < listed_.size(); ++k) {
            ids[2 * k] = listed_[k].lower_id;
            ids[2 * k + 1] = listed_[k].higher_id;
        }
        return ids;
    }

    int* write_parts(const Objects& objects)
    {
        int* parts = room_in(parts_, 2 * listed_.size());
        for (std::size_t k = 0; k < listed_.size(); ++k) {
            const Found& found = *listed_[k].found;
            const std::size_t first = 2 * k + (is_swapped(found) ? 1 : 0);
            parts[first] = objects[static_cast<int>(found.user_data1)].part_of(found.piece1);
            parts[4 * k + 1 - first] = objects[static_cast<int>(found.user_data2)].part_of(found.piece2);
        }
        return parts;
    }

    int* write_counts()
    {
        int* counts = room_in(counts_, listed_.size());
        for (std::size_t k = 0; k < listed_.size(); ++k) {
            counts[k] = listed_[k].distance < 0 ? -1 : 1;
        }
        return counts;
    }

    SWIFT_Real* write_distances()
    {
        SWIFT_Real* distances = room_in(distances_, listed_.size());
        for (std::size_t k = 0; k < listed_.size(); ++k) {
            distances[k] = listed_[k].distance;
        }
        return distances;
    }

    /* The lower ends of the intervals, and what the upper ends are beyond them. */
    SWIFT_Real* write_lower_ends(SWIFT_Real** errors)
    {
        SWIFT_Real* lower_ends = room_in(distances_, listed_.size());
        SWIFT_Real* widths = room_in(errors_, listed_.size());
        for (std::size_t k = 0; k < listed_.size(); ++k) {
            const swiftprox_pair_answer& answer = listed_[k].found->answer;
            if (listed_[k].distance < 0) {
                lower_ends[k] = -1;
                widths[k] = 0;
            } else {
                lower_ends[k] = rounded_down(answer.lower);
                widths[k] = width(lower_ends[k], answer.upper);
            }
        }
        if (errors != NULL) {
            *errors = widths;
        }
        return lower_ends;
    }

    /* Distances, points and normals, those of which the pointer is not null, in one go: what is found is large. */
    void write_contacts(SWIFT_Real** distances, SWIFT_Real** points, SWIFT_Real** normals)
    {
        const std::size_t count = listed_.size();
        SWIFT_Real* distance = room_for(distances, count, distances_);
        SWIFT_Real* point = room_for(points, 6 * count, points_);
        SWIFT_Real* normal = room_for(normals, 3 * count, normals_);
        for (std::size_t k = 0; k < count; ++k) {
            const swiftprox_pair_answer& answer = listed_[k].found->answer;
            const bool swaps = is_swapped(*listed_[k].found);
            if (distance != NULL) {
                *distance++ = listed_[k].distance;
            }
            if (point != NULL) {
                copy_scaled(swaps ? answer.local2 : answer.local1, 1, point);
                copy_scaled(swaps ? answer.local1 : answer.local2, 1, point + 3);
                point += 6;
            }
            if (normal != NULL) {
                copy_scaled(answer.normal, swaps ? -1 : 1, normal);
                normal += 3;
            }
        }
    }

    /* Each pointer may be null. */
    void write_features(const Objects& objects, IntersectingFeatures intersecting, int** types, int** ids)
    {
        feature_types_.clear();
        feature_ids_.clear();
        for (std::size_t k = 0; k < listed_.size(); ++k) {
            const Found& found = *listed_[k].found;
            const swiftprox_pair_answer& answer = found.answer;
            const Geometry& geometry1 = objects[static_cast<int>(found.user_data1)].geometry_of(found.piece1);
            const Geometry& geometry2 = objects[static_cast<int>(found.user_data2)].geometry_of(found.piece2);
            FeaturePair pair = {{FeatureSide(geometry1, answer.feature1, answer.local1),
                                 FeatureSide(geometry2, answer.feature2, answer.local2)}};
            if (is_swapped(found)) {
                std::swap(pair.sides[0], pair.sides[1]);
            }
            pair.reduce();
            const std::size_t begin = feature_ids_.size();
            for (int side = 0; side < 2; ++side) {
                feature_types_.push_back(pair.sides[side].type());
                pair.sides[side].append_ids(feature_ids_);
            }
            if (is_intersecting(found) && intersecting == INTERSECTING_TAKE_FOUR) {
                feature_ids_.resize(begin + 4, -1);
            }
        }
        if (types != NULL) {
            *types = begin_of(feature_types_);
        }
        if (ids != NULL) {
            *ids = begin_of(feature_ids_);
        }
    }

private:
    bool is_early_; /* the query ended at the one entry that there is */
    std::vector<Entry> listed_;
    std::vector<Entry> sorted_; /* these three for sorting */
    std::vector<int> ranks_;
    std::vector<std::size_t> places_;
    std::vector<int> ids_, parts_, counts_, feature_types_, feature_ids_;
    std::vector<SWIFT_Real> distances_, errors_, points_, normals_;

    /* By counting; entries of one rank stay as they are. */
    void sort_by_rank(std::size_t rank_count)
    {
        places_.assign(rank_count + 1, 0);
        for (std::size_t i = 0; i < ranks_.size(); ++i) {
            ++places_[static_cast<std::size_t>(ranks_[i]) + 1];
        }
        for (std::size_t rank = 1; rank <= rank_count; ++rank) {
            places_[rank] += places_[rank - 1];
        }
        sorted_.resize(listed_.size());
        for (std::size_t i = 0; i < ranks_.size(); ++i) {
            sorted_[places_[static_cast<std::size_t>(ranks_[i])]++] = listed_[i];
        }
        listed_.swap(sorted_);
    }

    /* An array of so many numbers, where it is asked for. */
    static SWIFT_Real* room_for(SWIFT_Real** wanted, std::size_t count, std::vector<SWIFT_Real>& numbers)
    {
        if (wanted == NULL) {
            return NULL;
        }
        *wanted = room_in(numbers, count);
        return *wanted;
    }

    static void copy_scaled(const double* from, double factor, SWIFT_Real* to)
    {
        to[0] = static_cast<SWIFT_Real>(factor * from[0]);
        to[1] = static_cast<SWIFT_Real>(factor * from[1]);
        to[2] = static_cast<SWIFT_Real>(factor * from[2]);
    }

    /*
     * Room for so many numbers. Old programs read the first entry without looking whether there is one: where there is none it is
     * zeros. Arrays do not shrink, so that queries which list now more and now less do not fill them anew.
     */
    template <class Value> static Value* room_in(std::vector<Value>& values, std::size_t count)
    {
        const std::size_t largest_entry = 6;
        if (values.size() < std::max(count, largest_entry)) {
            values.resize(std::max(count, largest_entry));
        }
        if (count == 0) {
            std::fill(values.begin(), values.begin() + largest_entry, Value());
        }
        return &values[0];
    }

    /* Of what was appended one by one. */
    template <class Value> static Value* begin_of(std::vector<Value>& values)
    {
        return values.empty() ? room_in(values, 0) : &values[0];
    }

    static SWIFT_Real rounded_down(double x)
    {
        const SWIFT_Real rounded = static_cast<SWIFT_Real>(x);
        return static_cast<double>(rounded) > x ? rounded - rounded * std::numeric_limits<SWIFT_Real>::epsilon() : rounded;
    }

    /* From a number up to another one, rounded up. */
    static SWIFT_Real width(SWIFT_Real from, double to)
    {
        const double exact = to - static_cast<double>(from);
        SWIFT_Real rounded = static_cast<SWIFT_Real>(exact);
        while (static_cast<double>(from) + static_cast<double>(rounded) < to || static_cast<double>(rounded) < exact) {
            rounded += rounded * std::numeric_limits<SWIFT_Real>::epsilon() + std::numeric_limits<SWIFT_Real>::min();
        }
        return rounded;
    }
};

} // namespace swift_legacy

#endif

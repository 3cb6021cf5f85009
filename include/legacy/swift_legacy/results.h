/* What the last query found, in the order and the arrays of old. */
#ifndef SWIFT_LEGACY_RESULTS_H
#define SWIFT_LEGACY_RESULTS_H

#include "features.h"
#include "objects.h"

namespace swift_legacy {

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
    void clear()
    {
        nearest_.clear();
        keep_nearest();
    }

    /* Takes what a query lists, by object 1, into the order by the object that was created later. The objects are ranked. */
    void take(const swiftprox_scene_answer& answer, const Objects& objects)
    {
        keep_nearest();
        nearest_.resize(answer.count);
        if (answer.count == 1) {
            nearest_[0] = Entry(answer.pairs[0]);
            return;
        }
        ranks_.resize(answer.count);
        int before = 0;
        bool is_in_order = true;
        for (std::size_t i = 0; i < answer.count; ++i) {
            nearest_[i] = Entry(answer.pairs[i]);
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
        return nearest_;
    }

    /* Makes one entry of all pairs of pieces of the same two parts. */
    void unite_parts(const Objects& objects)
    {
        std::vector<Entry> all;
        all.swap(nearest_);
        for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
            const Object& object1 = objects[static_cast<int>(all[begin].found->user_data1)];
            const Object& object2 = objects[static_cast<int>(all[begin].found->user_data2)];
            while (end < all.size() && all[end].lower_id == all[begin].lower_id && all[end].higher_id == all[begin].higher_id) {
                ++end;
            }
            const ByParts by_parts(object1, object2);
            std::stable_sort(all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end),
                             by_parts);
            for (std::size_t first = begin, last = begin; first < end; first = last) {
                while (last < end && !by_parts(all[first], all[last])) {
                    ++last;
                }
                unite(&all[first], &all[first] + (last - first));
            }
        }
    }

    int count() const
    {
        return static_cast<int>(nearest_.size());
    }

    /* Entry k of the distances; null where there is none. */
    const Found* found(int k) const
    {
        const std::vector<Entry>& shown = contacts();
        return k < 0 || static_cast<std::size_t>(k) >= shown.size() ? NULL : shown[static_cast<std::size_t>(k)].found;
    }

    /* Queries that do not tell contacts apart list the nearest one of each pair. */
    void keep_nearest()
    {
        contacts_.clear();
        contact_counts_.clear();
    }

    int* write_ids()
    {
        ids_.resize(2 * nearest_.size());
        for (std::size_t k = 0; k < nearest_.size(); ++k) {
            ids_[2 * k] = nearest_[k].lower_id;
            ids_[2 * k + 1] = nearest_[k].higher_id;
        }
        return begin_of(ids_);
    }

    int* write_parts(const Objects& objects)
    {
        const std::vector<Entry>& shown = contacts();
        parts_.resize(2 * shown.size());
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const Found& found = *shown[k].found;
            const std::size_t first = 2 * k + (is_swapped(found) ? 1 : 0);
            parts_[first] = objects[static_cast<int>(found.user_data1)].part_of[found.piece1];
            parts_[4 * k + 1 - first] = objects[static_cast<int>(found.user_data2)].part_of[found.piece2];
        }
        return begin_of(parts_);
    }

    int* write_counts()
    {
        if (!contacts_.empty()) {
            return begin_of(contact_counts_);
        }
        counts_.resize(nearest_.size());
        for (std::size_t k = 0; k < nearest_.size(); ++k) {
            counts_[k] = nearest_[k].distance < 0 ? -1 : 1;
        }
        return begin_of(counts_);
    }

    SWIFT_Real* write_distances()
    {
        const std::vector<Entry>& shown = contacts();
        distances_.resize(shown.size());
        for (std::size_t k = 0; k < shown.size(); ++k) {
            distances_[k] = shown[k].distance;
        }
        return begin_of(distances_);
    }

    /* The lower ends of the intervals, and what the upper ends are beyond them. */
    SWIFT_Real* write_lower_ends(SWIFT_Real** errors)
    {
        distances_.resize(nearest_.size());
        errors_.resize(nearest_.size());
        for (std::size_t k = 0; k < nearest_.size(); ++k) {
            const swiftprox_pair_answer& answer = nearest_[k].found->answer;
            if (nearest_[k].distance < 0) {
                distances_[k] = -1;
                errors_[k] = 0;
            } else {
                distances_[k] = rounded_down(answer.lower);
                errors_[k] = width(distances_[k], answer.upper);
            }
        }
        if (errors != NULL) {
            *errors = begin_of(errors_);
        }
        return begin_of(distances_);
    }

    /* Distances, points and normals, those of which the pointer is not null, in one go: what is found is large. */
    void write_contacts(SWIFT_Real** distances, SWIFT_Real** points, SWIFT_Real** normals)
    {
        const std::vector<Entry>& shown = contacts();
        const std::size_t count = shown.size();
        SWIFT_Real* distance = room_for(distances, count, distances_);
        SWIFT_Real* point = room_for(points, 6 * count, points_);
        SWIFT_Real* normal = room_for(normals, 3 * count, normals_);
        for (std::size_t k = 0; k < count; ++k) {
            const swiftprox_pair_answer& answer = shown[k].found->answer;
            const bool swaps = is_swapped(*shown[k].found);
            if (distance != NULL) {
                *distance++ = shown[k].distance;
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
        const std::vector<Entry>& shown = contacts();
        feature_types_.clear();
        feature_ids_.clear();
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const Found& found = *shown[k].found;
            const swiftprox_pair_answer& answer = found.answer;
            const Geometry& geometry1 = *objects[static_cast<int>(found.user_data1)].pieces[found.piece1];
            const Geometry& geometry2 = *objects[static_cast<int>(found.user_data2)].pieces[found.piece2];
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
    std::vector<Entry> nearest_;  /* one for each listed pair */
    std::vector<Entry> contacts_; /* those of all pairs, where pairs have several; else empty */
    std::vector<int> contact_counts_;
    std::vector<Entry> sorted_;   /* these three for sorting */
    std::vector<int> ranks_;
    std::vector<std::size_t> places_;
    std::vector<int> ids_, parts_, counts_, feature_types_, feature_ids_;
    std::vector<SWIFT_Real> distances_, errors_, points_, normals_;

    struct ByParts {
        const Object* object1;
        const Object* object2;

        ByParts(const Object& first, const Object& second) : object1(&first), object2(&second) {}

        std::pair<int, int> parts(const Entry& entry) const
        {
            return std::make_pair(object1->part_of[entry.found->piece1], object2->part_of[entry.found->piece2]);
        }

        bool operator()(const Entry& a, const Entry& b) const
        {
            return parts(a) < parts(b);
        }
    };

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
        sorted_.resize(nearest_.size());
        for (std::size_t i = 0; i < ranks_.size(); ++i) {
            sorted_[places_[static_cast<std::size_t>(ranks_[i])]++] = nearest_[i];
        }
        nearest_.swap(sorted_);
    }

    const std::vector<Entry>& contacts() const
    {
        return contacts_.empty() ? nearest_ : contacts_;
    }

    /* Adds an entry: the first intersecting pair of pieces, else those that are nearer than all before them. */
    void unite(const Entry* begin, const Entry* end)
    {
        const std::size_t before = contacts_.size();
        for (const Entry* entry = begin; entry != end; ++entry) {
            if (entry->distance < 0) {
                contacts_.resize(before);
                contacts_.push_back(*entry);
                contact_counts_.push_back(-1);
                nearest_.push_back(*entry);
                return;
            }
            if (contacts_.size() == before || entry->found->answer.distance < contacts_.back().found->answer.distance) {
                contacts_.push_back(*entry);
            }
        }
        contact_counts_.push_back(static_cast<int>(contacts_.size() - before));
        nearest_.push_back(contacts_.back());
    }

    /* An array of so many numbers, where it is asked for. */
    static SWIFT_Real* room_for(SWIFT_Real** wanted, std::size_t count, std::vector<SWIFT_Real>& numbers)
    {
        if (wanted == NULL) {
            return NULL;
        }
        numbers.resize(count);
        *wanted = begin_of(numbers);
        return *wanted;
    }

    static void copy_scaled(const double* from, double factor, SWIFT_Real* to)
    {
        to[0] = static_cast<SWIFT_Real>(factor * from[0]);
        to[1] = static_cast<SWIFT_Real>(factor * from[1]);
        to[2] = static_cast<SWIFT_Real>(factor * from[2]);
    }

    template <class Value> static Value* begin_of(std::vector<Value>& values)
    {
        return values.empty() ? NULL : &values[0];
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

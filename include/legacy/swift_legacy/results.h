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

/* The distance of old. */
inline SWIFT_Real distance_of(const Found& found)
{
    return is_intersecting(found) ? static_cast<SWIFT_Real>(-1) : static_cast<SWIFT_Real>(found.answer.distance);
}

class Results {
public:
    void clear()
    {
        nearest_.clear();
        contacts_.clear();
        counts_.clear();
    }

    /* Takes what a query lists, by object 1, into the order by the object that was created later. The objects are ranked. */
    void take(const swiftprox_scene_answer& answer, const Objects& objects)
    {
        clear();
        nearest_.resize(answer.count);
        places_.assign(objects.created().size() + 1, 0);
        for (std::size_t i = 0; i < answer.count; ++i) {
            ++places_[later_rank(answer.pairs[i], objects) + 1];
        }
        for (std::size_t rank = 1; rank < places_.size(); ++rank) {
            places_[rank] += places_[rank - 1];
        }
        for (std::size_t i = 0; i < answer.count; ++i) {
            nearest_[places_[later_rank(answer.pairs[i], objects)]++] = &answer.pairs[i];
        }
    }

    std::vector<const Found*>& listed()
    {
        return nearest_;
    }

    /* Makes one entry of all pairs of pieces of the same two parts. */
    void unite_parts(const Objects& objects)
    {
        std::vector<const Found*> all;
        all.swap(nearest_);
        for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
            const Object& object1 = objects[static_cast<int>(all[begin]->user_data1)];
            const Object& object2 = objects[static_cast<int>(all[begin]->user_data2)];
            while (end < all.size() && all[end]->user_data1 == all[begin]->user_data1 &&
                   all[end]->user_data2 == all[begin]->user_data2) {
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

    /* Of entry k of the distances. */
    const swiftprox_pair_answer* answer(int k) const
    {
        const std::vector<const Found*>& shown = contacts_.empty() ? nearest_ : contacts_;
        return k < 0 || static_cast<std::size_t>(k) >= shown.size() ? NULL : &shown[static_cast<std::size_t>(k)]->answer;
    }

    /* Queries that do not tell contacts apart list the nearest one of each pair. */
    void keep_nearest()
    {
        contacts_.clear();
        counts_.clear();
    }

    int* write_ids()
    {
        return write_pairs(ids_, nearest_, IdOf());
    }

    int* write_parts(const Objects& objects)
    {
        return write_pairs(parts_, contacts(), PartOf(objects));
    }

    int* write_counts()
    {
        if (contacts_.empty()) {
            counts_.resize(nearest_.size());
            for (std::size_t k = 0; k < nearest_.size(); ++k) {
                counts_[k] = is_intersecting(*nearest_[k]) ? -1 : 1;
            }
        }
        return begin_of(counts_);
    }

    SWIFT_Real* write_distances()
    {
        const std::vector<const Found*>& shown = contacts();
        distances_.resize(shown.size());
        for (std::size_t k = 0; k < shown.size(); ++k) {
            distances_[k] = distance_of(*shown[k]);
        }
        return begin_of(distances_);
    }

    /* The lower ends of the intervals, and what the upper ends are beyond them. */
    SWIFT_Real* write_lower_ends(SWIFT_Real** errors)
    {
        distances_.resize(nearest_.size());
        errors_.resize(nearest_.size());
        for (std::size_t k = 0; k < nearest_.size(); ++k) {
            const swiftprox_pair_answer& answer = nearest_[k]->answer;
            if (is_intersecting(*nearest_[k])) {
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

    SWIFT_Real* write_points()
    {
        const std::vector<const Found*>& shown = contacts();
        points_.resize(6 * shown.size());
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const swiftprox_pair_answer& answer = shown[k]->answer;
            const bool swaps = is_swapped(*shown[k]);
            const double* first = swaps ? answer.local2 : answer.local1;
            const double* second = swaps ? answer.local1 : answer.local2;
            SWIFT_Real* points = &points_[6 * k];
            for (int axis = 0; axis < 3; ++axis) {
                points[axis] = static_cast<SWIFT_Real>(first[axis]);
                points[3 + axis] = static_cast<SWIFT_Real>(second[axis]);
            }
        }
        return begin_of(points_);
    }

    SWIFT_Real* write_normals()
    {
        const std::vector<const Found*>& shown = contacts();
        normals_.resize(3 * shown.size());
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const double* normal = shown[k]->answer.normal;
            const bool swaps = is_swapped(*shown[k]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                normals_[3 * k + axis] = static_cast<SWIFT_Real>(swaps ? -normal[axis] : normal[axis]);
            }
        }
        return begin_of(normals_);
    }

    /* Each pointer may be null. */
    void write_features(const Objects& objects, IntersectingFeatures intersecting, int** types, int** ids)
    {
        const std::vector<const Found*>& shown = contacts();
        feature_types_.clear();
        feature_ids_.clear();
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const Found& found = *shown[k];
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
    std::vector<const Found*> nearest_;  /* one for each listed pair */
    std::vector<const Found*> contacts_; /* those of all pairs, where pairs have several; else empty */
    std::vector<std::size_t> places_;
    std::vector<int> ids_, parts_, counts_, feature_types_, feature_ids_;
    std::vector<SWIFT_Real> distances_, errors_, points_, normals_;

    struct ByParts {
        const Object* object1;
        const Object* object2;

        ByParts(const Object& first, const Object& second) : object1(&first), object2(&second) {}

        std::pair<int, int> parts(const Found* found) const
        {
            return std::make_pair(object1->part_of[found->piece1], object2->part_of[found->piece2]);
        }

        bool operator()(const Found* a, const Found* b) const
        {
            return parts(a) < parts(b);
        }
    };

    struct IdOf {
        int operator()(const Found& found, int side) const
        {
            return static_cast<int>(side == 0 ? found.user_data1 : found.user_data2);
        }
    };

    struct PartOf {
        const Objects* objects;

        explicit PartOf(const Objects& all) : objects(&all) {}

        int operator()(const Found& found, int side) const
        {
            return side == 0 ? (*objects)[static_cast<int>(found.user_data1)].part_of[found.piece1]
                             : (*objects)[static_cast<int>(found.user_data2)].part_of[found.piece2];
        }
    };

    static std::size_t later_rank(const Found& found, const Objects& objects)
    {
        return static_cast<std::size_t>(objects[static_cast<int>(found.user_data2)].rank);
    }

    const std::vector<const Found*>& contacts() const
    {
        return contacts_.empty() ? nearest_ : contacts_;
    }

    /* Adds an entry: the first intersecting pair of pieces, else those that are nearer than all before them. */
    void unite(const Found* const* begin, const Found* const* end)
    {
        const std::size_t before = contacts_.size();
        for (const Found* const* found = begin; found != end; ++found) {
            if (is_intersecting(**found)) {
                contacts_.resize(before);
                contacts_.push_back(*found);
                counts_.push_back(-1);
                nearest_.push_back(*found);
                return;
            }
            if (contacts_.size() == before || (*found)->answer.distance < contacts_.back()->answer.distance) {
                contacts_.push_back(*found);
            }
        }
        counts_.push_back(static_cast<int>(contacts_.size() - before));
        nearest_.push_back(contacts_.back());
    }

    template <class Value> static Value* begin_of(std::vector<Value>& values)
    {
        return values.empty() ? NULL : &values[0];
    }

    /* Two numbers of each, the lower id's first. */
    template <class Number> static int* write_pairs(std::vector<int>& out, const std::vector<const Found*>& shown, const Number& number)
    {
        out.resize(2 * shown.size());
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const int lower = is_swapped(*shown[k]) ? 1 : 0;
            out[2 * k] = number(*shown[k], lower);
            out[2 * k + 1] = number(*shown[k], 1 - lower);
        }
        return begin_of(out);
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

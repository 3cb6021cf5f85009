/* The pairs of objects whose boxes overlap, for queries that list by boxes: sorted along an axis and swept. */
#ifndef SWIFT_LEGACY_BOX_PAIRS_H
#define SWIFT_LEGACY_BOX_PAIRS_H

#include "objects.h"

namespace swift_legacy {

/*
 * What boxes are grown by, so that objects that intersect are never missed. A pose may stretch a body by (1 + 3 * 0.01)^(1/2), less
 * than 1.02; an enlargement may be negative; and coordinates are rounded, by less than this part of the largest.
 */
const double BOX_STRETCH = 0.02, BOX_ROUNDING = 1e-12;

class BoxPairs {
public:
    /* Finds them anew, where the boxes of all objects stand; whether they are others than before. */
    bool find(const Objects& objects)
    {
        take_boxes(objects);
        const int axis = longest_axis();
        std::sort(rows_.begin(), rows_.end(), ByLower(axis));
        found_.clear();
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            for (std::size_t j = i + 1; j < rows_.size() && rows_[j].box.lower[axis] <= rows_[i].box.upper[axis]; ++j) {
                if (!(rows_[i].is_fixed && rows_[j].is_fixed) && overlap(rows_[i].box, rows_[j].box)) {
                    found_.push_back(rows_[i].native);
                    found_.push_back(rows_[j].native);
                }
            }
        }
        const bool are_others = found_.size() != pairs_.size() || !std::equal(found_.begin(), found_.end(), pairs_.begin(), is_same);
        pairs_.swap(found_);
        return are_others;
    }

    /* Two objects for each pair. */
    const std::vector<swiftprox_object_id>& pairs() const
    {
        return pairs_;
    }

private:
    struct Row {
        Box box;
        swiftprox_object_id native;
        bool is_fixed;
    };

    struct ByLower {
        int axis;

        explicit ByLower(int along) : axis(along) {}

        bool operator()(const Row& a, const Row& b) const
        {
            return a.box.lower[axis] < b.box.lower[axis];
        }
    };

    std::vector<Row> rows_;
    std::vector<swiftprox_object_id> pairs_, found_;

    static bool is_same(const swiftprox_object_id& a, const swiftprox_object_id& b)
    {
        return a.bits == b.bits;
    }

    /* A row for each object: the box of all its parts. */
    void take_boxes(const Objects& objects)
    {
        rows_.clear();
        double largest = 0;
        for (std::size_t i = 0; i < objects.created().size(); ++i) {
            const Object& object = objects[objects.created()[i]];
            Row row = {object.parts[0].world_box, object.native, object.is_fixed};
            double margin = 0;
            for (std::size_t part = 0; part < object.parts.size(); ++part) {
                const Part& own = object.parts[part];
                row.box.take_in(own.world_box.lower);
                row.box.take_in(own.world_box.upper);
                margin = std::max(margin, BOX_STRETCH * own.radius + std::max(0.0, -own.enlargement()));
            }
            row.box.grow(margin);
            for (int axis = 0; axis < 3; ++axis) {
                largest = std::max(largest, std::max(-row.box.lower[axis], row.box.upper[axis]));
            }
            rows_.push_back(row);
        }
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            rows_[i].box.grow(BOX_ROUNDING * largest);
        }
    }

    /* Along which the boxes are spread the farthest. */
    int longest_axis() const
    {
        Box whole = Box();
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (i == 0) {
                whole = rows_[i].box;
            }
            whole.take_in(rows_[i].box.lower);
            whole.take_in(rows_[i].box.upper);
        }
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis) {
            if (whole.upper[axis] - whole.lower[axis] > whole.upper[longest] - whole.lower[longest]) {
                longest = axis;
            }
        }
        return longest;
    }
};

} // namespace swift_legacy

#endif

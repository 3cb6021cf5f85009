/* Numbers in the binary files of SWIFT++'s decomposer, behind a header of words. */
#ifndef SWIFT_LEGACY_BINARY_NUMBERS_H
#define SWIFT_LEGACY_BINARY_NUMBERS_H

#include <algorithm>
#include <cstring>
#include <fstream>
#include <locale>
#include <stdint.h>
#include <string>
#include <vector>

#include "messages.h"

namespace swift_legacy {

/* What the words of the header say of the bytes behind it. */
struct BinaryForm {
    bool is_big_endian, is_float;
};

/* Empty when the form could be read, else what is wrong with it. The stream stands behind it. */
inline std::string read_binary_form(std::ifstream& stream, BinaryForm& form)
{
    stream.imbue(std::locale::classic());
    std::string magic, binary, endian, real, kind;
    stream >> magic >> binary >> endian >> real >> kind;
    if (binary != "binary" || (endian != "big_endian" && endian != "little_endian")) {
        return "the byte order is missing";
    }
    if (real != "real" || (kind != "float" && kind != "double")) {
        return "the kind of its real numbers is missing";
    }
    form.is_big_endian = endian == "big_endian";
    form.is_float = kind == "float";
    return "";
}

/* The same of counts that are each behind its name, the last one at the end of the header. */
inline std::string read_named_counts(std::ifstream& stream, const char* const* names, int* const* counts, int count)
{
    for (int i = 0; i < count; ++i) {
        std::string name;
        if (!(stream >> name >> *counts[i]) || name != names[i] || *counts[i] < 0) {
            return std::string("the number of ") + names[i] + " is missing";
        }
    }
    const int line_end = stream.get();
    return line_end == '\n' || (line_end == '\r' && stream.get() == '\n') ? "" : "the header does not end in a new line";
}

/* What lies behind the header: numbers in the byte order of the file. */
class BinaryNumbers {
public:
    BinaryNumbers(std::ifstream& stream, const BinaryForm& form) : at_(0), is_whole_(true), is_float_(form.is_float)
    {
        char block[4096];
        while (stream.read(block, sizeof block), stream.gcount() > 0) {
            bytes_.insert(bytes_.end(), block, block + stream.gcount());
        }
        const uint16_t one = 1;
        unsigned char low;
        std::memcpy(&low, &one, 1);
        swaps_ = form.is_big_endian == (low == 1);
    }

    double real()
    {
        if (is_float_) {
            return take<float>();
        }
        return take<double>();
    }

    int integer()
    {
        return take<int32_t>();
    }

    /* False once a number was missing. */
    bool is_whole() const
    {
        return is_whole_;
    }

    bool is_at_end() const
    {
        return at_ == bytes_.size();
    }

private:
    std::vector<char> bytes_;
    std::size_t at_;
    bool is_whole_;
    bool is_float_;
    bool swaps_;

    template <class Number> Number take()
    {
        Number number = 0;
        if (bytes_.size() - at_ < sizeof number) {
            is_whole_ = false;
            return 0;
        }
        char bytes[sizeof number];
        std::copy(&bytes_[at_], &bytes_[at_] + sizeof number, bytes);
        at_ += sizeof number;
        if (swaps_) {
            std::reverse(bytes, bytes + sizeof number);
        }
        std::memcpy(&number, bytes, sizeof number);
        return number;
    }
};

/* So many numbers, each at least 0 and below a limit; false where one is not, or is missing. */
inline bool read_integers(BinaryNumbers& numbers, int count, int limit, std::vector<int>& values)
{
    values.clear();
    for (int i = 0; i < count && numbers.is_whole(); ++i) {
        values.push_back(numbers.integer());
        if (values.back() < 0 || values.back() >= limit) {
            return false;
        }
    }
    return numbers.is_whole();
}

/* So many vertices; empty, or what is wrong with them. */
inline std::string read_vertices(BinaryNumbers& numbers, int count, std::vector<double>& vertices)
{
    for (int i = 0; i < count && numbers.is_whole(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            vertices.push_back(numbers.real());
            if (numbers.is_whole() && !(vertices.back() - vertices.back() <= 0)) {
                return "vertex " + text(i) + " is not finite";
            }
        }
    }
    return numbers.is_whole() ? "" : "it is cut off among its vertices";
}

} // namespace swift_legacy

#endif

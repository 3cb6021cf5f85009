/* What a call returns, and what it throws; ranges of what somebody else owns. */
#ifndef SWIFTPROX_RESULT_HPP
#define SWIFTPROX_RESULT_HPP

#include "../swiftprox.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
#define SWIFTPROX_HAS_EXCEPTIONS 1
#include <stdexcept>
#else
#define SWIFTPROX_HAS_EXCEPTIONS 0
#endif

namespace swiftprox
{

/** A status in words, and what was wrong, which the next call of this thread that fails may overwrite. */
struct [[nodiscard]] Status {
    swiftprox_status status = SWIFTPROX_OK;
    /** Null: the library has the message. */
    const char *own_message = nullptr;
    explicit operator bool() const noexcept { return status == SWIFTPROX_OK; }
    const char *message() const noexcept { return own_message ? own_message : swiftprox_library_last_error_message(); }
};

namespace detail
{
/** The value of a call that failed: T::none() of what has one, else what a T begins with. */
template <class T, class = void> struct Nothing {
    static T make() { return T{}; }
};
template <class T> struct Nothing<T, std::void_t<decltype(T::none())>> {
    static T make() { return T::none(); }
};
} // namespace detail

/** A status, and what the call gives where that is SWIFTPROX_OK. */
template <class T> struct [[nodiscard]] Result : Status {
    T value = detail::Nothing<T>::make();
};
template <> struct [[nodiscard]] Result<void> : Status {
};

#if SWIFTPROX_HAS_EXCEPTIONS
/** What a call throws that fails: the status, and what was wrong and where. */
class Error : public std::runtime_error
{
  public:
    Error(swiftprox_status status, const char *message) : std::runtime_error(message), status_(status) {}
    swiftprox_status status() const noexcept { return status_; }

  private:
    swiftprox_status status_;
};

/** The value of a result, or an Error with its message. */
template <class T> T take(Result<T> &&result)
{
    if (!result) {
        throw Error(result.status, result.message());
    }
    if constexpr (!std::is_void_v<T>) {
        return std::move(result.value);
    }
}
#endif

/** Elements that somebody else owns, one after the other. */
template <class T> class Range
{
  public:
    constexpr Range() noexcept = default;
    constexpr Range(T *first, std::size_t count) noexcept : first_(first), count_(count) {}
    /** Of anything with data() and size(): a vector, an array, a std::span. */
    template <class Container, class = std::enable_if_t<std::is_convertible_v<decltype(std::declval<Container &>().data()), T *>>>
    constexpr Range(Container &&container) noexcept : first_(container.data()), count_(container.size()) {}
    constexpr T *begin() const noexcept { return first_; }
    constexpr T *end() const noexcept { return first_ + count_; }
    constexpr T *data() const noexcept { return first_; }
    constexpr std::size_t size() const noexcept { return count_; }
    constexpr bool empty() const noexcept { return count_ == 0; }
    constexpr T &operator[](std::size_t index) const noexcept { return first_[index]; }

  private:
    T *first_ = nullptr;
    std::size_t count_ = 0;
};

namespace detail
{
inline Result<void> status(swiftprox_status status) noexcept
{
    Result<void> result;
    result.status = status;
    return result;
}

/** The result of a call that writes its value through a pointer. */
template <class T, class Call> Result<T> asked(Call &&call)
{
    Result<T> result;
    result.status = call(&result.value);
    return result;
}

template <class T> Result<T> refused(const char *message)
{
    Result<T> result;
    result.status = SWIFTPROX_ERROR_INVALID_ARGUMENT;
    result.own_message = message;
    return result;
}

/** What is wrong with the lengths of a mesh's arrays, which C has to take on trust; null if they fit. */
inline const char *mesh_fault(Range<const double> vertices, Range<const std::uint32_t> indices,
                              Range<const std::uint32_t> valences) noexcept
{
    std::size_t corners = 0;
    for (const std::uint32_t sides : valences) {
        corners += sides;
    }
    if (vertices.size() % 3 != 0) {
        return "vertices: the number of coordinates is not a multiple of 3";
    }
    if (valences.empty() && indices.size() % 3 != 0) {
        return "indices: their number is not a multiple of 3, and no valences are given";
    }
    return !valences.empty() && corners != indices.size() ? "valences: their sum is not the number of indices" : nullptr;
}
/** The arrays of a mesh whose lengths fit. */
inline swiftprox_mesh mesh_of(Range<const double> vertices, Range<const std::uint32_t> indices,
                              Range<const std::uint32_t> valences) noexcept
{
    if (valences.empty()) {
        return {vertices.data(), vertices.size() / 3, indices.data(), nullptr, indices.size() / 3};
    }
    return {vertices.data(), vertices.size() / 3, indices.data(), valences.data(), valences.size()};
}
} // namespace detail

} // namespace swiftprox

#endif

/* Strew for C++11 and newer: handles that free themselves, and exceptions with the words of the library. */

#ifndef STREW_HPP
#define STREW_HPP

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "strew.h"

namespace strew {

/* What went wrong. what() has the words of REST: the field, its value and what is allowed. */
class Error : public std::runtime_error {
public:
    explicit Error(strew_code code)
        : std::runtime_error(strew_error_message()), code(code), kind(strew_error_kind()),
          field(strew_error_field()), document(strew_error_document()) {}

    /* The code of the call. */
    strew_code code;
    /* The kind of problem: invalid-query, too-many-points, ... */
    std::string kind;
    /* The first field that is wrong, or empty. */
    std::string field;
    /* Everything that is wrong, as JSON. */
    std::string document;
};

/* Throws an Error unless the code is STREW_OK. */
inline void check(strew_code code) {
    if (code != STREW_OK) throw Error(code);
}

namespace detail {

struct Free {
    void operator()(strew_library *handle) const { strew_library_free(handle); }
    void operator()(strew_plan *handle) const { strew_plan_free(handle); }
    void operator()(strew_bytes *handle) const { strew_bytes_free(handle); }
};

inline std::string text(strew_bytes *handle) {
    std::unique_ptr<strew_bytes, Free> bytes(handle);
    return std::string(strew_bytes_data(bytes.get()), strew_bytes_length(bytes.get()));
}

} // namespace detail

/* A planned query, with Axes coordinates for each point: its points are counted, and made when they are wanted. */
template <std::size_t Axes>
class BasicPlan {
public:
    explicit BasicPlan(strew_plan *handle) : handle_(handle) {}

    /* The exact number of points. */
    std::uint64_t count() const {
        std::uint64_t count = 0;
        check(strew_plan_count(get(), &count));
        return count;
    }

    /* What the numbers of coordinates() are relative to. */
    std::array<double, Axes> origin() const {
        std::array<double, Axes> origin{};
        check(strew_plan_origin(get(), origin.data()));
        return origin;
    }

    /* The coordinates of each point, by turns: x, y, in space z. */
    std::vector<double> coordinates() const {
        std::vector<double> at(Axes * count());
        check(strew_plan_fill_coordinates(get(), at.data(), at.size()));
        return at;
    }

    /* The same as float, relative to the lower corner of the region, which is written to `origin`. */
    std::vector<float> coordinates_f32(std::array<double, Axes> *origin = nullptr) const {
        std::vector<float> at(Axes * count());
        check(strew_plan_fill_coordinates_f32(get(), at.data(), at.size(), origin ? origin->data() : nullptr));
        return at;
    }

    /* The integers of each id, by turns. */
    std::vector<std::int64_t> ids() const {
        std::vector<std::int64_t> ids(Axes * count());
        check(strew_plan_fill_ids(get(), ids.data(), ids.size()));
        return ids;
    }

    /* A column of numbers, such as angle. */
    std::vector<double> numbers(const std::string &column) const {
        std::vector<double> values(count());
        check(strew_plan_fill_numbers(get(), column.c_str(), values.data(), values.size()));
        return values;
    }

    /* A column of names, such as variant: indices into the names that columns() lists. */
    std::vector<std::int32_t> codes(const std::string &column) const {
        std::vector<std::int32_t> values(count());
        check(strew_plan_fill_codes(get(), column.c_str(), values.data(), values.size()));
        return values;
    }

    /* The columns and their names, as JSON. */
    std::string columns() const {
        strew_bytes *bytes = nullptr;
        check(strew_plan_columns(get(), &bytes));
        return detail::text(bytes);
    }

    /* The points as a document: format=csv&decimals=2. */
    std::string document(const std::string &options) const {
        strew_bytes *bytes = nullptr;
        check(strew_plan_document(get(), options.c_str(), &bytes));
        return detail::text(bytes);
    }

    /* The handle, which stays this object's. */
    const strew_plan *get() const { return handle_.get(); }

private:
    std::unique_ptr<strew_plan, detail::Free> handle_;
};

/* A planned query of the plane, and one in space. */
using Plan = BasicPlan<2>;
using SpacePlan = BasicPlan<3>;

/* Tables, with which queries are answered. Threads may share one. */
class Library {
public:
    /* The built-in tables, and those of a folder, if one is named. */
    explicit Library(const std::string &folder = "") {
        strew_library *handle = nullptr;
        check(strew_library_open(folder.empty() ? nullptr : folder.c_str(), &handle));
        handle_.reset(handle);
    }

    /* Plans a query: JSON, or text such as bbox=0,0,10,10&spacing=1&seed=7. */
    Plan plan(const std::string &query) const { return planned<2>(query); }

    /* Plans a query in space: JSON, or text such as ball=5,5,5,3&spacing=1&seed=7. */
    SpacePlan space(const std::string &query) const { return planned<3>(query); }

    /* Plans a chunk of a query without a region, by its indices along the axes: two of them, or three in space. */
    template <std::size_t Axes>
    BasicPlan<Axes> chunk(const std::string &query, double size, const std::array<std::int64_t, Axes> &at) const {
        strew_plan *plan = nullptr;
        check(strew_plan_chunk(get(), Axes, query.c_str(), size, at.data(), &plan));
        return BasicPlan<Axes>(plan);
    }

    Plan chunk(const std::string &query, double size, std::int64_t column, std::int64_t row) const {
        return chunk<2>(query, size, {{column, row}});
    }

    /* The points nearest to a place: at=5,5&k=3&spacing=1, in space at=5,5,5. At most `most` are returned. */
    std::vector<strew_point> nearest(const std::string &query, std::size_t most = 1024) const {
        return near(2, query, most);
    }

    std::vector<strew_point> space_nearest(const std::string &query, std::size_t most = 1024) const {
        return near(3, query, most);
    }

    /* The point of an id, of two integers or three in space, in a set such as spacing=1&seed=7. */
    template <std::size_t Axes>
    strew_point point(const std::string &set, const std::array<std::int64_t, Axes> &id) const {
        strew_point found{};
        check(strew_point_by_id(get(), Axes, set.c_str(), id.data(), &found, nullptr));
        return found;
    }

    strew_point point(const std::string &set, std::int64_t x, std::int64_t y) const {
        return point<2>(set, {{x, y}});
    }

    /* The handle, which stays this object's. */
    const strew_library *get() const { return handle_.get(); }

private:
    template <std::size_t Axes>
    BasicPlan<Axes> planned(const std::string &query) const {
        strew_plan *plan = nullptr;
        check(strew_plan_query(get(), Axes, query.c_str(), &plan));
        return BasicPlan<Axes>(plan);
    }

    std::vector<strew_point> near(std::uint32_t axes, const std::string &query, std::size_t most) const {
        std::vector<strew_point> found(most);
        std::size_t count = 0;
        check(strew_nearest(get(), axes, query.c_str(), found.data(), most, &count, nullptr));
        found.resize(count < most ? count : most);
        return found;
    }

    std::unique_ptr<strew_library, detail::Free> handle_;
};

} // namespace strew

#endif /* STREW_HPP */

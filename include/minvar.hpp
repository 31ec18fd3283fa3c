/*
 * minvar in C++17: a thin layer over minvar.h, header-only.
 *
 *     using minvar::Joint;
 *     const minvar::Solution coving = minvar::solve({
 *         Joint::at({0.5, -12, 0}).fix_tangent({0, 1, 0}).fix_curvature({0.27, 0, 0}),
 *         Joint::at({20, -0.5, 0}).fix_tangent({1, 0, 0}),
 *     });
 *     minvar::Curve(coving.elements).write_gcode(std::cout, minvar::GcodeOptions(0.001, 40, 2));
 *
 * Units      As in minvar.h: lengths in the caller's unit, curvatures 1/length, angles radians, feeds length/minute. A
 *            tolerance is a length. Planar signed curvature is positive to the left. Parameters run 0 to 1 an element.
 * Errors     What minvar.h returns as a code is thrown as minvar::Error; the functions' comments in minvar.h list them.
 *            Memory that cannot be had is std::bad_alloc. How a solve ended is not an error but a Status: look at
 *            Solution::converged().
 * Callbacks  May throw. The exception is kept while the C library returns, then thrown on: none crosses a C frame.
 * Memory     Everything is a value and owns what it holds. The library itself never allocates; its memory is a
 *            std::vector of a Solver, kept from solve to solve.
 * Threads    There is no global state. A Solver belongs to one thread at a time; the const functions of a Curve may be
 *            called by any number of threads at once.
 *
 * Licence: MIT or Apache-2.0.
 */
#ifndef MINVAR_HPP
#define MINVAR_HPP

#include "minvar.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace minvar {

// ---- Plain data --------------------------------------------------------------------------------------------------

/// A point or a vector: x, y, z.
using Vec = std::array<double, 3>;

/// A quintic Hermite element: the rows C(0), C'(0), C''(0), C''(1), C'(1), C(1). May be copied, stored and sent.
using Element = minvar_element;
/// What one iteration of a solve did.
using Record = minvar_record;
/// How a curve came out, with its length, variation and bending energy.
using Report = minvar_report;
/// What holds at a place of a curve: position, tangent, curvature, torsion.
using Point = minvar_point;
/// The figures of a whole curve.
using Figures = minvar_figures;
/// One move of a path: a line (turn 0), an arc to the left (1) or to the right (-1).
using Move = minvar_move;
/// What a G-code program holds.
using Summary = minvar_gcode_summary;

/// Whether a quantity of a joint is the solver's to choose: free, a start value, or kept exactly.
enum class Given : std::uint32_t {
    Free = MINVAR_FREE,
    Initial = MINVAR_INITIAL,
    Fixed = MINVAR_FIXED,
    OnLine = MINVAR_ON_LINE,
    OnPlane = MINVAR_ON_PLANE,
    Size = MINVAR_SIZE,
};

/// How the two elements at a joint meet: a corner (G0), a common tangent (G1), tangent and curvature (G2).
enum class Continuity : std::uint32_t { G0 = MINVAR_G0, G1 = MINVAR_G1, G2 = MINVAR_G2 };

/// What a curve is to minimise: the variation of curvature (Mvc), the bending energy (Mec), or their scale-invariant forms,
/// L^3 times the one (SiMvc) and L times the other (SiMec), or those of space curves that count torsion too, as the square
/// of its change (SpaceMvc) or its own (SpaceMec).
enum class Functional : std::uint32_t {
    Mvc = MINVAR_MVC,
    Mec = MINVAR_MEC,
    SiMvc = MINVAR_SI_MVC,
    SiMec = MINVAR_SI_MEC,
    SpaceMvc = MINVAR_SPACE_MVC,
    SpaceMec = MINVAR_SPACE_MEC,
};

/// How a computation ended.
enum class Status : std::uint32_t {
    Unsolved = MINVAR_UNSOLVED,
    Converged = MINVAR_CONVERGED,
    Stalled = MINVAR_STALLED,
    IterationLimit = MINVAR_ITERATION_LIMIT,
    Unbounded = MINVAR_UNBOUNDED,
    Cancelled = MINVAR_CANCELLED
};

/// The side of a joint: of the element that arrives there, or of the one that leaves.
enum class Side : std::size_t { Arriving = 0, Leaving = 1 };

/// The unit of all lengths of a G-code program.
enum class Units : std::uint32_t { Millimetres = MINVAR_MILLIMETRES, Inches = MINVAR_INCHES };

/// The machine's plane in which the curve's x and y lie.
enum class Plane : std::uint32_t { XY = MINVAR_XY, ZX = MINVAR_ZX, YZ = MINVAR_YZ };

/// How a path is cut: G2/G3 arcs and lines of a curve in a plane z = constant, or chords of any curve.
enum class Motion : std::uint32_t { Arcs = MINVAR_ARCS, Chords = MINVAR_CHORDS };

/// One English sentence on a status that a user can act on.
inline std::string_view sentence(Status status) noexcept {
    return minvar_status_sentence(static_cast<std::uint32_t>(status));
}

/// The version of the library that is linked or loaded, "MAJOR.MINOR.PATCH".
inline std::string_view version() noexcept { return minvar_version(); }

// ---- Errors ------------------------------------------------------------------------------------------------------

/// What was wrong with a call. Nothing was computed and no result was written.
class Error : public std::runtime_error {
public:
    explicit Error(const minvar_error &error) : std::runtime_error(error.message), error_(error) {}

    /// Which error: the numbers are fixed for good, the sentence of what() is not.
    minvar_code code() const noexcept { return error_.code; }
    /// The joint, element, obstacle or option, from 0, that is to blame, where the code says so; else 0.
    std::size_t index() const noexcept { return error_.index; }
    /// All that the library told.
    const minvar_error &details() const noexcept { return error_; }

private:
    minvar_error error_;
};

namespace detail {

/// Calls a C function with the arguments and an error of ours; throws what it found.
template <typename Function, typename... Arguments>
void call(Function function, Arguments... arguments) {
    minvar_error error;
    if (function(arguments..., &error) != MINVAR_OK) {
        throw Error(error);
    }
}

/// Throws if the library has another interface than this header was compiled with; looked up once a program.
inline void require_abi() {
    static const bool same = minvar_abi_check(MINVAR_ABI) == 1;
    if (!same) {
        throw std::runtime_error("libminvar " + std::string(version()) +
                                 " has another interface than the minvar.h that this program was compiled with");
    }
}

/// A callback on its way through C: the function that it calls, and the exception that the function threw.
template <typename... Arguments>
class Bridge {
public:
    explicit Bridge(std::function<bool(Arguments...)> function) : function_(std::move(function)) {}

    /// For C: 0 to go on, 1 to stop.
    std::int32_t operator()(Arguments... arguments) noexcept {
        try {
            return function_(arguments...) ? 0 : 1;
        } catch (...) {
            thrown_ = std::current_exception();
            return 1;
        }
    }

    /// Throws on what the function threw, if it did.
    void rethrow() const {
        if (thrown_) {
            std::rethrow_exception(thrown_);
        }
    }

private:
    std::function<bool(Arguments...)> function_;
    std::exception_ptr thrown_;
};

using ObserverBridge = Bridge<std::size_t, const Record &>;
using VisitorBridge = Bridge<const Move &>;
using WriterBridge = Bridge<std::string_view>;

extern "C" {
inline std::int32_t minvar_hpp_observe(void *bridge, std::size_t iteration, const minvar_record *record) noexcept {
    return (*static_cast<ObserverBridge *>(bridge))(iteration, *record);
}
inline std::int32_t minvar_hpp_visit(void *bridge, const minvar_move *step) noexcept {
    return (*static_cast<VisitorBridge *>(bridge))(*step);
}
inline std::int32_t minvar_hpp_write(void *bridge, const char *text, std::size_t length) noexcept {
    return (*static_cast<WriterBridge *>(bridge))(std::string_view(text, length));
}
}

}  // namespace detail

// ---- What is given -----------------------------------------------------------------------------------------------

/// A joint: a point of the curve with what is known there. Each function returns the joint with one thing changed.
///
///     Joint::at({0, 0, 0}).fix_tangent({1, 0, 0}).start_curvature({0, 0.1, 0})
///
/// A tangent may have any length but zero. A curvature vector points to the centre of curvature, has length 1/radius
/// and is perpendicular to the tangent. Without a side a quantity holds on both; sides may differ only where the
/// continuity leaves them independent: tangents at a corner, curvatures there and at a G1 joint. Nothing is checked
/// before the solve, whose errors name the joint.
class Joint {
public:
    /// A G2 joint at a fixed point; tangent and curvature are free.
    [[nodiscard]] static Joint at(const Vec &point) { return Joint(minvar_joint_at(point[0], point[1], point[2])); }
    /// A G2 joint at a point that is a start value; tangent and curvature are free.
    [[nodiscard]] static Joint start_at(const Vec &point) { return at(point).position(Given::Initial, point); }
    /// A G2 joint that slides on the line through a point, where it starts, along a direction; tangent and curvature are free.
    [[nodiscard]] static Joint on_line(const Vec &p, const Vec &d) {
        return Joint(minvar_joint_on_line(at(p).data_, p[0], p[1], p[2], d[0], d[1], d[2]));
    }
    /// A G2 joint that slides in the plane through a point, where it starts, across a normal; tangent and curvature are free.
    [[nodiscard]] static Joint on_plane(const Vec &p, const Vec &n) {
        return Joint(minvar_joint_on_plane(at(p).data_, p[0], p[1], p[2], n[0], n[1], n[2]));
    }
    /// A G2 joint held at a place of a curve: position, tangent and curvature fixed as they are there.
    [[nodiscard]] static Joint held_at(const Point &place) { return Joint(minvar_joint_held_at(place)); }
    /// A G2 joint anywhere between its neighbours; tangent and curvature are free.
    [[nodiscard]] static Joint anywhere() { return at({}).position(Given::Free, {}); }

    [[nodiscard]] Joint fix_tangent(const Vec &v) const { return both(&minvar_joint::tangent, Given::Fixed, v); }
    [[nodiscard]] Joint start_tangent(const Vec &v) const { return both(&minvar_joint::tangent, Given::Initial, v); }
    [[nodiscard]] Joint free_tangent() const { return both(&minvar_joint::tangent, Given::Free, {}); }
    [[nodiscard]] Joint fix_curvature(const Vec &v) const { return both(&minvar_joint::curvature, Given::Fixed, v); }
    [[nodiscard]] Joint start_curvature(const Vec &v) const { return both(&minvar_joint::curvature, Given::Initial, v); }
    /// A curvature whose size is kept; its direction is that of the start.
    [[nodiscard]] Joint size_curvature(const Vec &v) const { return both(&minvar_joint::curvature, Given::Size, v); }
    [[nodiscard]] Joint free_curvature() const { return both(&minvar_joint::curvature, Given::Free, {}); }

    /// One side alone.
    [[nodiscard]] Joint tangent(Side side, Given given, const Vec &v) const {
        return one(&minvar_joint::tangent, side, given, v);
    }
    /// One side alone.
    [[nodiscard]] Joint curvature(Side side, Given given, const Vec &v) const {
        return one(&minvar_joint::curvature, side, given, v);
    }

    [[nodiscard]] Joint position(Given given, const Vec &point) const {
        Joint joint = *this;
        joint.data_.position = quantity(given, point);
        return joint;
    }
    [[nodiscard]] Joint continuity(Continuity kind) const {
        return Joint(minvar_joint_with_continuity(data_, static_cast<std::uint32_t>(kind)));
    }
    /// G0: tangent and curvature are independent on either side.
    [[nodiscard]] Joint corner() const { return continuity(Continuity::G0); }
    /// G1: a common tangent, curvatures independent on either side.
    [[nodiscard]] Joint smooth() const { return continuity(Continuity::G1); }

    /// As the C interface has it.
    const minvar_joint &data() const noexcept { return data_; }

private:
    friend class Region;
    explicit Joint(const minvar_joint &data) : data_(data) {}

    static minvar_quantity quantity(Given given, const Vec &v) {
        return {static_cast<std::uint32_t>(given), {v[0], v[1], v[2]}};
    }
    using Sides = minvar_quantity (minvar_joint::*)[2];
    Joint one(Sides sides, Side side, Given given, const Vec &v) const {
        Joint joint = *this;
        (joint.data_.*sides)[static_cast<std::size_t>(side)] = quantity(given, v);
        return joint;
    }
    Joint both(Sides sides, Given given, const Vec &v) const {
        return one(sides, Side::Arriving, given, v).one(sides, Side::Leaving, given, v);
    }

    minvar_joint data_;
};

/// A region of a solved curve, to be computed anew while the rest stays as it is (thesis 4.4, local control): `count`
/// elements from `first` on, from 0; of a closed curve they may run past the last element into the first ones.
///
///     const Region region(curve, 2, 2);
///     solver.update_from(region.elements(), region.hold({Joint::anywhere(), Joint::at({3, 2.7, 0}), Joint::anywhere()}));
///     curve = region.replaced(solver.solution().elements);
class Region {
public:
    /// Throws Error if the curve has no such region, or has no direction where the region joins the rest.
    Region(std::vector<Element> curve, std::size_t first, std::size_t count, bool closed = false)
        : curve_(std::move(curve)), first_(first), count_(count), closed_(closed) {
        hold({Joint::anywhere(), Joint::anywhere()});
    }

    /// The region's joints as an open curve's: the first and the last held to the rest, as far as their continuity makes
    /// things common; where the curve itself ends they stay as given. Inner joints may be moved, added and removed.
    std::vector<Joint> hold(std::vector<Joint> joints) const {
        detail::require_abi();
        std::vector<minvar_joint> held;
        for (const Joint &joint : joints) {
            held.push_back(joint.data());
        }
        detail::call(minvar_region_hold, curve_.data(), curve_.size(), closed_ ? 1 : 0, first_, count_, held.data(),
                     held.size());
        joints.front() = Joint(held.front());
        joints.back() = Joint(held.back());
        return joints;
    }

    /// The region's elements in order.
    std::vector<Element> elements() const {
        std::vector<Element> result;
        for (std::size_t i = 0; i < count_; ++i) {
            result.push_back(curve_[(first_ + i) % curve_.size()]);
        }
        return result;
    }

    /// The whole curve with other elements for the region's, any number. It starts where it did, unless the region runs
    /// past the last element: then it starts where the region ends.
    std::vector<Element> replaced(const std::vector<Element> &fresh) const {
        std::vector<Element> result;
        for (std::size_t i = first_ + count_ > curve_.size() ? first_ + count_ - curve_.size() : 0; i < first_; ++i) {
            result.push_back(curve_[i]);
        }
        result.insert(result.end(), fresh.begin(), fresh.end());
        for (std::size_t i = first_ + count_; i < curve_.size(); ++i) {
            result.push_back(curve_[i]);
        }
        return result;
    }

private:
    std::vector<Element> curve_;
    std::size_t first_;
    std::size_t count_;
    bool closed_;
};

/// A point or a segment that a planar curve leaves on one side, at a distance or more.
///
///     Obstacle::segment({0, -6, 0}, {6, -6, 0}, 0.25, Obstacle::Side::Left)
///
/// Nothing is checked before the solve, whose errors name the obstacle.
class Obstacle {
public:
    /// The side of the curve, in the direction in which it runs, on which the obstacle stays. minvar.h says from where the
    /// plane is seen.
    enum class Side : std::uint32_t { Left = MINVAR_LEFT, Right = MINVAR_RIGHT };

    /// A point.
    [[nodiscard]] static Obstacle point(const Vec &at, double clearance, Side side) {
        return segment(at, at, clearance, side);
    }
    /// A segment.
    [[nodiscard]] static Obstacle segment(const Vec &a, const Vec &b, double clearance, Side side) {
        return Obstacle({{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, clearance, static_cast<std::uint32_t>(side)});
    }

    /// As the C interface has it.
    const minvar_obstacle &data() const noexcept { return data_; }

private:
    explicit Obstacle(const minvar_obstacle &data) : data_(data) {}

    minvar_obstacle data_;
};

/// A shape that a curve keeps to as far as its joints allow (thesis 4.6): as many elements as the curve will have,
/// Solution::elements of before its joints moved, say. With the weight 1 the shape is kept, towards 0 it is smoothed away.
struct Reference {
    std::vector<Element> elements;
    double weight = 1;
};

/// The options of a curve, with the library's defaults, and what is asked of it beyond its joints. minvar.h says what each
/// may be.
struct Options {
    Functional functional = static_cast<Functional>(minvar_options_defaults().functional);
    std::uint32_t elements_per_span = minvar_options_defaults().elements_per_span;
    std::uint32_t quadrature_points = minvar_options_defaults().quadrature_points;
    std::uint32_t max_iterations = minvar_options_defaults().max_iterations;
    std::uint32_t dimension = minvar_options_defaults().dimension;
    std::uint32_t continuation = minvar_options_defaults().continuation;
    double relative_decrease = minvar_options_defaults().relative_decrease;
    double tension = minvar_options_defaults().tension;
    double bending = minvar_options_defaults().bending;
    double length = minvar_options_defaults().length;
    double tolerance = minvar_options_defaults().tolerance;
    /// What a planar curve keeps clear of.
    std::vector<Obstacle> obstacles = {};
    /// The shape that it keeps to; none without elements.
    Reference reference = {};

    /// As the C interface has it, which keeps obstacles and reference with the joints.
    minvar_options data() const noexcept {
        minvar_options options = minvar_options_defaults();
        options.functional = static_cast<std::uint32_t>(functional);
        options.elements_per_span = elements_per_span;
        options.quadrature_points = quadrature_points;
        options.max_iterations = max_iterations;
        options.dimension = dimension;
        options.continuation = continuation;
        options.relative_decrease = relative_decrease;
        options.tension = tension;
        options.bending = bending;
        options.length = length;
        options.tolerance = tolerance;
        return options;
    }
};

/// Watches a solve: called on the solving thread after every iteration with its number, from 1, and its record, which
/// lives until the function returns. Returns whether to go on; if not, the solve ends with Status::Cancelled and the
/// best curve so far. May throw.
using Observer = std::function<bool(std::size_t iteration, const Record &record)>;

// ---- Solving -----------------------------------------------------------------------------------------------------

/// A computed curve.
struct Solution {
    /// The elements in order along the curve: Options::elements_per_span a span, with a tolerance fewer, and so many more
    /// for each place where it touches an obstacle.
    std::vector<Element> elements;
    /// How the computation ended, with figures.
    Report report{};
    /// What each iteration did; empty of minima.
    std::vector<Record> records;

    Status status() const noexcept { return static_cast<Status>(report.status); }
    bool converged() const noexcept { return status() == Status::Converged; }
};

/// Computes curves, one after the other, and keeps its memory for the next: once it has seen the largest of them, it
/// does not allocate any more.
class Solver {
public:
    /// Computes a curve through the joints in order; a closed one returns from the last to the first, which is not
    /// repeated. The solution is the solver's, good until its next solve: copy or take() what is to stay.
    ///
    /// Throws Error for what is wrong with joints or options, found before any work; the solution before it is whole
    /// then. Throws on what the observer throws, after the best curve so far has become the solution.
    const Solution &solve(const std::vector<Joint> &joints, bool closed = false, const Options &options = {},
                          const Observer &observer = {}) {
        const minvar_options chosen = options.data();
        const minvar_curve curve = prepare(joints, closed, options, chosen);
        solution_.elements.resize(minvar_curve_elements_len(&curve, &chosen));
        detail::ObserverBridge bridge = watch(observer);
        detail::call(minvar_curve_solve, &curve, &chosen, workspace_.data(), workspace_.size(),
                     detail::minvar_hpp_observe, &bridge, solution_.elements.data(), solution_.elements.size(),
                     static_cast<minvar_record *>(nullptr), std::size_t{0}, &solution_.report);
        solution_.elements.resize(solution_.report.elements);
        bridge.rethrow();
        return solution_;
    }

    /// Computes the last curve anew after its joints changed a little, as when one is dragged: a warm start from the last
    /// solution, which the new one replaces. As many joints and elements as then, and no obstacles; the curve does not jump
    /// to another minimum. Throws as solve() does.
    const Solution &update(const std::vector<Joint> &joints, bool closed = false, const Options &options = {},
                           const Observer &observer = {}) {
        const minvar_options chosen = options.data();
        const minvar_curve curve = prepare(joints, closed, options, chosen);
        detail::ObserverBridge bridge = watch(observer);
        detail::call(minvar_curve_update, &curve, &chosen, workspace_.data(), workspace_.size(),
                     detail::minvar_hpp_observe, &bridge, solution_.elements.data(), solution_.elements.size(),
                     &solution_.report);
        bridge.rethrow();
        return solution_;
    }

    /// As update(), from elements that need not be this solver's: those of a file, or of a region. As many as the curve has.
    const Solution &update_from(std::vector<Element> start, const std::vector<Joint> &joints, bool closed = false,
                                const Options &options = {}, const Observer &observer = {}) {
        solution_.elements.swap(start);
        try {
            update(joints, closed, options, observer);
        } catch (const Error &) {
            solution_.elements.swap(start);
            throw;
        }
        solution_.elements.resize(solution_.report.elements);
        return solution_;
    }

    /// Looks for local minima, at most so many, and returns those that it found, the lowest first (thesis 4.10: curves with
    /// and without a loop); none where none converged. The solver's own solution stays. The observer sees every solve begin
    /// with iteration 1; where it stops one, what was found before is returned. Throws as solve() does.
    std::vector<Solution> minima(const std::vector<Joint> &joints, std::size_t most, bool closed = false,
                                 const Options &options = {}, const Observer &observer = {}) {
        const minvar_options chosen = options.data();
        const minvar_curve curve = prepare(joints, closed, options, chosen);
        const std::size_t length = minvar_curve_elements_len(&curve, &chosen);
        std::vector<Report> reports(most);
        std::vector<Element> elements((most + 1) * length);
        std::size_t found = 0;
        detail::ObserverBridge bridge([&observer](std::size_t iteration, const Record &record) {
            return !observer || observer(iteration, record);
        });
        detail::call(minvar_curve_minima, &curve, &chosen, workspace_.data(), workspace_.size(),
                     detail::minvar_hpp_observe, &bridge, elements.data(), elements.size(), reports.data(),
                     reports.size(), &found);
        bridge.rethrow();
        std::vector<Solution> result(found);
        for (std::size_t i = 0; i < found; ++i) {
            const Element *first = elements.data() + i * length;
            result[i].elements.assign(first, first + reports[i].elements);
            result[i].report = reports[i];
        }
        return result;
    }

    /// The last solution; empty and Status::Unsolved before the first.
    const Solution &solution() const noexcept { return solution_; }

    /// The last solution, moved out.
    Solution take() { return std::exchange(solution_, Solution{}); }

private:
    /// The curve through joints and past obstacles that are kept, with memory for solving it; throws for what is wrong with
    /// them or the options. The reference stays the caller's.
    minvar_curve prepare(const std::vector<Joint> &joints, bool closed, const Options &options,
                         const minvar_options &chosen) {
        detail::require_abi();
        joints_.clear();
        for (const Joint &joint : joints) {
            joints_.push_back(joint.data());
        }
        obstacles_.clear();
        for (const Obstacle &obstacle : options.obstacles) {
            obstacles_.push_back(obstacle.data());
        }
        minvar_curve curve = minvar_curve_through(joints_.data(), joints_.size(), closed ? 1 : 0);
        curve.obstacles = obstacles_.data();
        curve.obstacle_count = obstacles_.size();
        if (!options.reference.elements.empty()) {
            curve.reference = options.reference.elements.data();
            curve.reference_count = options.reference.elements.size();
            curve.reference_weight = options.reference.weight;
        }
        std::size_t needed = 0;
        detail::call(minvar_curve_workspace_len, &curve, &chosen, &needed);
        if (workspace_.size() < needed) {
            workspace_.resize(needed);
        }
        return curve;
    }

    /// Begins the solution's records anew; they are written while the observer, which must outlive this, watches.
    detail::ObserverBridge watch(const Observer &observer) {
        solution_.records.clear();
        return detail::ObserverBridge([this, &observer](std::size_t iteration, const Record &record) {
            solution_.records.push_back(record);
            return !observer || observer(iteration, record);
        });
    }

    std::vector<minvar_joint> joints_;
    std::vector<minvar_obstacle> obstacles_;
    std::vector<double> workspace_;
    Solution solution_;
};

/// Computes one curve; see Solver::solve().
inline Solution solve(const std::vector<Joint> &joints, bool closed = false, const Options &options = {},
                      const Observer &observer = {}) {
    Solver solver;
    solver.solve(joints, closed, options, observer);
    return solver.take();
}

/// Looks for local minima of one curve; see Solver::minima().
inline std::vector<Solution> minima(const std::vector<Joint> &joints, std::size_t most, bool closed = false,
                                    const Options &options = {}, const Observer &observer = {}) {
    return Solver().minima(joints, most, closed, options, observer);
}

// ---- Measuring, converting, paths --------------------------------------------------------------------------------

/// A non-rational B-spline of degree 5.
struct BSpline {
    std::vector<Vec> controls;
    /// Six more than control points, from 0 to 1.
    std::vector<double> knots;
};

/// What a G-code program is to be; lengths are in the program's unit. minvar.h says what each field may be.
struct GcodeOptions {
    /// The three that have no default: the greatest distance between printed path and curve, the cutting feed in
    /// length/minute, and the height of rapid moves, above the cut.
    GcodeOptions(double tolerance_, double feed_, double safe_height_)
        : GcodeOptions(minvar_gcode_defaults(tolerance_, feed_, safe_height_)) {}

    double tolerance;
    double feed;
    double plunge_feed;
    double safe_height;
    double depth;
    Units units;
    Plane plane;
    Motion motion;
    std::uint32_t decimals;
    bool comments;

    /// As the C interface has it.
    minvar_gcode_options data() const noexcept {
        minvar_gcode_options options = minvar_gcode_defaults(tolerance, feed, safe_height);
        options.plunge_feed = plunge_feed;
        options.depth = depth;
        options.units = static_cast<std::uint32_t>(units);
        options.plane = static_cast<std::uint32_t>(plane);
        options.motion = static_cast<std::uint32_t>(motion);
        options.decimals = decimals;
        options.comments = comments ? 1 : 0;
        return options;
    }

private:
    explicit GcodeOptions(const minvar_gcode_options &d)
        : tolerance(d.tolerance), feed(d.feed), plunge_feed(d.plunge_feed), safe_height(d.safe_height),
          depth(d.depth), units(static_cast<Units>(d.units)), plane(static_cast<Plane>(d.plane)),
          motion(static_cast<Motion>(d.motion)), decimals(d.decimals), comments(d.comments != 0) {}
};

/// A chain of elements as one curve. It is only read: all functions are const, and any number of threads may call them.
class Curve {
public:
    /// Any elements will do that follow on each other; they are checked by the functions that read them.
    explicit Curve(std::vector<Element> elements) : elements_(std::move(elements)) { detail::require_abi(); }

    const std::vector<Element> &elements() const noexcept { return elements_; }

    /// Length, variation, bending energy, extremes of curvature and bounding box.
    Figures figures() const {
        Figures figures;
        detail::call(minvar_measure, elements_.data(), elements_.size(), &figures);
        return figures;
    }
    /// The length L. Measures everything: take figures() for more than one of them.
    double length() const { return figures().length; }
    /// The variation of curvature V in 1/length^3. Measures everything: take figures() for more than one of them.
    double variation() const { return figures().variation; }

    /// What holds at parameter `t`, 0 to 1, of an element, from 0.
    Point at(std::size_t element, double t) const {
        Point point;
        detail::call(minvar_point_at, elements_.data(), elements_.size(), element, t, &point);
        return point;
    }
    /// What holds at arc length `s`, from 0 to length().
    Point at_length(double s) const {
        Point point;
        detail::call(minvar_point_at_length, elements_.data(), elements_.size(), s, &point);
        return point;
    }
    /// The place nearest to a point; of several equally near ones the first. None is missed.
    Point closest(const Vec &to) const {
        Point point;
        detail::call(minvar_closest_point, elements_.data(), elements_.size(), to[0], to[1], to[2], &point);
        return point;
    }

    /// The six Bézier control points of an element, from 0. Throws std::out_of_range if there is no such element.
    std::array<Vec, 6> bezier(std::size_t element) const {
        double points[6][3];
        detail::call(minvar_element_bezier, &elements_.at(element), &points);
        std::array<Vec, 6> result;
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] = {points[i][0], points[i][1], points[i][2]};
        }
        return result;
    }
    /// The whole curve as one B-spline, the same point by point.
    BSpline bspline() const {
        std::size_t control_count = 0;
        std::size_t knot_count = 0;
        detail::call(minvar_bspline_len, elements_.data(), elements_.size(), &control_count, &knot_count);
        const std::unique_ptr<double[][3]> controls(new double[control_count][3]);
        BSpline result{std::vector<Vec>(control_count), std::vector<double>(knot_count)};
        detail::call(minvar_bspline, elements_.data(), elements_.size(), controls.get(), control_count,
                     result.knots.data(), knot_count);
        for (std::size_t i = 0; i < control_count; ++i) {
            result.controls[i] = {controls[i][0], controls[i][1], controls[i][2]};
        }
        return result;
    }

    /// Lines, each within the tolerance of its part of the curve. The first begins where the curve does.
    std::vector<Move> chords(double tolerance) const { return moves(minvar_chords, tolerance); }
    /// Arcs and lines within the tolerance of a curve in a plane z = constant, tangent-continuous but for the curve's
    /// corners. The first begins where the curve does.
    std::vector<Move> arcs(double tolerance) const { return moves(minvar_arcs, tolerance); }

    /// Writes one complete G-code program. Throws Error before the first character for what is wrong with curve or
    /// options, and with MINVAR_STOPPED if the stream failed: what is on it is incomplete then. A stream that throws
    /// throws its own.
    Summary write_gcode(std::ostream &out, const GcodeOptions &options) const {
        return write(options, [&out](std::string_view text) {
            return static_cast<bool>(out.write(text.data(), static_cast<std::streamsize>(text.size())));
        });
    }
    /// The G-code program as text.
    std::string gcode(const GcodeOptions &options) const {
        std::string program;
        write(options, [&program](std::string_view text) {
            program.append(text);
            return true;
        });
        return program;
    }

private:
    /// What minvar_chords() and minvar_arcs() are.
    using Path = decltype(&minvar_chords);

    std::vector<Move> moves(Path path, double tolerance) const {
        std::vector<Move> result;
        detail::VisitorBridge bridge([&result](const Move &step) {
            result.push_back(step);
            return true;
        });
        end(bridge, path, elements_.data(), elements_.size(), tolerance, detail::minvar_hpp_visit, &bridge);
        return result;
    }
    Summary write(const GcodeOptions &options, std::function<bool(std::string_view)> writer) const {
        const minvar_gcode_options chosen = options.data();
        Summary summary;
        detail::WriterBridge bridge(std::move(writer));
        end(bridge, minvar_write_gcode, elements_.data(), elements_.size(), &chosen, detail::minvar_hpp_write, &bridge,
            &summary);
        return summary;
    }
    /// A call with a callback, whose own exception says more than that it stopped.
    template <typename Bridge, typename Function, typename... Arguments>
    static void end(const Bridge &bridge, Function function, Arguments... arguments) {
        try {
            detail::call(function, arguments...);
        } catch (const Error &) {
            bridge.rethrow();
            throw;
        }
    }

    std::vector<Element> elements_;
};

}  // namespace minvar

#endif  // MINVAR_HPP

// Everything of minvar.hpp, against the C interface that it wraps.
#include "minvar.hpp"

#include "check.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sstream>
#include <streambuf>

using minvar::Continuity;
using minvar::Curve;
using minvar::GcodeOptions;
using minvar::Given;
using minvar::Joint;
using minvar::Obstacle;
using minvar::Options;
using minvar::Region;
using minvar::Side;
using minvar::Solution;
using minvar::Solver;
using minvar::Status;

double length_in_another_unit(const Curve &curve);

// Counts what the program allocates.
static std::size_t allocations;

void *operator new(std::size_t size) {
    allocations++;
    if (void *place = std::malloc(size)) {
        return place;
    }
    throw std::bad_alloc();
}
void operator delete(void *place) noexcept { std::free(place); }
void operator delete(void *place, std::size_t) noexcept { std::free(place); }

namespace {

std::vector<Joint> coving_joints() {
    return {Joint::at({0.5, -12, 0}).fix_tangent({0, 1, 0}).fix_curvature({0.27, 0, 0}),
            Joint::at({20, -0.5, 0}).fix_tangent({1, 0, 0})};
}

Options with_elements(std::uint32_t elements_per_span) {
    Options options;
    options.elements_per_span = elements_per_span;
    return options;
}

template <typename T>
bool same(const T &a, const T &b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

template <typename T>
bool same(const std::vector<T> &a, const std::vector<T> &b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool equal(const minvar_quantity &q, Given given, const minvar::Vec &v) {
    return q.given == static_cast<std::uint32_t>(given) && q.value[0] == v[0] && q.value[1] == v[1] &&
           q.value[2] == v[2];
}

void joints() {
    const std::vector<Joint> ours = coving_joints();
    minvar_joint theirs[2];
    coving(theirs);
    for (std::size_t i = 0; i < 2; ++i) {
        const minvar_joint &a = ours[i].data();
        CHECK(a.continuity == theirs[i].continuity);
        CHECK(same(a.position.value, theirs[i].position.value) && a.position.given == theirs[i].position.given);
        for (int side = 0; side < 2; ++side) {
            CHECK(a.tangent[side].given == theirs[i].tangent[side].given);
            CHECK(same(a.tangent[side].value, theirs[i].tangent[side].value));
            CHECK(a.curvature[side].given == theirs[i].curvature[side].given);
            CHECK(same(a.curvature[side].value, theirs[i].curvature[side].value));
        }
    }
    const minvar::Vec v = {1, 2, 3}, w = {3, 0, -1};
    const minvar_joint a = Joint::start_at(v).start_tangent(v).start_curvature(w).corner().data();
    CHECK(a.continuity == MINVAR_G0 && equal(a.position, Given::Initial, v));
    CHECK(equal(a.tangent[0], Given::Initial, v) && equal(a.tangent[1], Given::Initial, v));
    CHECK(equal(a.curvature[0], Given::Initial, w) && equal(a.curvature[1], Given::Initial, w));
    const minvar_joint b = Joint::anywhere()
                               .smooth()
                               .tangent(Side::Arriving, Given::Fixed, v)
                               .tangent(Side::Leaving, Given::Initial, w)
                               .curvature(Side::Leaving, Given::Fixed, v)
                               .data();
    CHECK(b.continuity == MINVAR_G1 && b.position.given == MINVAR_FREE);
    CHECK(equal(b.tangent[0], Given::Fixed, v) && equal(b.tangent[1], Given::Initial, w));
    CHECK(b.curvature[0].given == MINVAR_FREE && equal(b.curvature[1], Given::Fixed, v));
    const minvar_joint c =
        Joint::at(v).fix_tangent(v).free_tangent().fix_curvature(w).free_curvature().continuity(Continuity::G2).data();
    CHECK(c.continuity == MINVAR_G2 && c.tangent[0].given == MINVAR_FREE && c.tangent[1].given == MINVAR_FREE);
    CHECK(c.curvature[0].given == MINVAR_FREE && c.curvature[1].given == MINVAR_FREE);
}

void options() {
    const minvar_options ours = Options{}.data(), theirs = minvar_options_defaults();
    CHECK(ours.functional == theirs.functional && ours.elements_per_span == theirs.elements_per_span);
    CHECK(ours.quadrature_points == theirs.quadrature_points && ours.max_iterations == theirs.max_iterations);
    CHECK(ours.dimension == theirs.dimension && ours.relative_decrease == theirs.relative_decrease);
    Options other;
    other.functional = minvar::Functional::Mec;
    other.elements_per_span = 2;
    other.quadrature_points = 20;
    other.max_iterations = 7;
    other.dimension = 3;
    other.relative_decrease = 0.5;
    const minvar_options changed = other.data();
    CHECK(changed.functional == MINVAR_MEC && changed.elements_per_span == 2 && changed.quadrature_points == 20);
    CHECK(changed.max_iterations == 7 && changed.dimension == 3 && changed.relative_decrease == 0.5);
#if __cplusplus >= 202002L
    CHECK((Options{.elements_per_span = 8}.data().elements_per_span == 8));
#endif

    GcodeOptions gcode(0.25, 40, 2);
    const minvar_gcode_options plain = gcode.data(), default_ = minvar_gcode_defaults(0.25, 40, 2);
    CHECK(plain.tolerance == 0.25 && plain.feed == 40 && plain.safe_height == 2);
    CHECK(plain.plunge_feed == default_.plunge_feed && plain.depth == default_.depth);
    CHECK(plain.units == default_.units && plain.plane == default_.plane && plain.motion == default_.motion);
    CHECK(plain.decimals == default_.decimals && plain.comments == default_.comments);
    gcode.plunge_feed = 5;
    gcode.depth = -1;
    gcode.units = minvar::Units::Inches;
    gcode.plane = minvar::Plane::YZ;
    gcode.motion = minvar::Motion::Chords;
    gcode.decimals = 7;
    gcode.comments = true;
    const minvar_gcode_options set = gcode.data();
    CHECK(set.plunge_feed == 5 && set.depth == -1 && set.units == MINVAR_INCHES && set.plane == MINVAR_YZ);
    CHECK(set.motion == MINVAR_CHORDS && set.decimals == 7 && set.comments == 1);
}

void solving() {
    const Solution one = minvar::solve(coving_joints());
    NEAR(one.report.variation, 0.0083518606, 1e-8);
    CHECK(one.converged() && one.elements.size() == 1);
    const Solution eight = minvar::solve(coving_joints(), false, with_elements(8));
    NEAR(eight.report.variation, 0.0083516963, 1e-8);
    CHECK(eight.converged() && eight.elements.size() == 8 && eight.records.size() == eight.report.iterations);
    CHECK(minvar::sentence(eight.status()).substr(0, 9) == "converged");
    CHECK(minvar::version() == MINVAR_VERSION_EXPECTED);

    // A reused solver gives the same bits, and allocates no more.
    Solver solver;
    CHECK(solver.solution().status() == Status::Unsolved && solver.solution().elements.empty());
    const std::vector<Joint> joints = coving_joints();
    const Options options = with_elements(8);
    const minvar::Observer nobody;
    solver.solve(joints, false, options, nobody);
    const std::size_t before = allocations;
    for (int i = 0; i < 3; ++i) {
        solver.solve(joints, false, with_elements(1), nobody);
        CHECK(same(solver.solution().elements, one.elements));
        solver.solve(joints, false, options, nobody);
        CHECK(same(solver.solution().elements, eight.elements) && same(solver.solution().records, eight.records));
        CHECK(same(solver.solution().report, eight.report));
    }
    CHECK(allocations == before);

    // Bad data are an Error that says what is wrong; the solution before them stays.
    try {
        solver.solve({Joint::at({0, 0, 0}), Joint::at({1, 0, 0}).fix_tangent({0, 0, 0})});
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_ZERO_TANGENT && error.index() == 1);
        CHECK(std::string(error.what()).find("joint 1") != std::string::npos);
        CHECK(error.details().code == MINVAR_ZERO_TANGENT);
    }
    try {
        solver.solve({});
        CHECK(!"thrown");
    } catch (const std::runtime_error &error) {
        CHECK(std::string(error.what()).find("two joints") != std::string::npos);
    }
    CHECK(same(solver.solution().elements, eight.elements) && same(solver.solution().report, eight.report));

    // Watched, cancelled, and left by an exception.
    std::size_t calls = 0;
    solver.solve(joints, false, options, [&](std::size_t iteration, const minvar::Record &record) {
        CHECK(iteration == ++calls && record.value == eight.records[calls - 1].value);
        return true;
    });
    CHECK(calls == eight.report.iterations && same(solver.solution().elements, eight.elements));
    solver.solve(joints, false, options, [](std::size_t iteration, const minvar::Record &) { return iteration < 3; });
    CHECK(solver.solution().status() == Status::Cancelled && !solver.solution().converged());
    CHECK(solver.solution().report.iterations == 3 && solver.solution().records.size() == 3);
    struct Enough {
        int reason;
    };
    try {
        solver.solve(joints, false, options, [](std::size_t iteration, const minvar::Record &) -> bool {
            throw Enough{static_cast<int>(iteration)};
        });
        CHECK(!"thrown");
    } catch (const Enough &enough) {
        CHECK(enough.reason == 1);
    }
    CHECK(solver.solution().status() == Status::Cancelled && solver.solution().elements.size() == 8);
    solver.solve(joints, false, options);
    CHECK(same(solver.solution().elements, eight.elements));
    const Solution taken = solver.take();
    CHECK(same(taken.elements, eight.elements) && solver.solution().elements.empty());
    CHECK(same(solver.solve(joints, false, options).elements, eight.elements));
}

/// The duct of the coving: its two faces, to the left of the curve.
std::vector<Obstacle> duct(double clearance) {
    return {Obstacle::segment({0, -6, 0}, {6, -6, 0}, clearance, Obstacle::Side::Left),
            Obstacle::segment({6, -6, 0}, {6, 0, 0}, clearance, Obstacle::Side::Left)};
}

void obstacles() {
    const minvar_obstacle point = Obstacle::point({1, 2, 3}, 0.5, Obstacle::Side::Right).data();
    CHECK(point.from[2] == 3 && point.to[0] == 1 && point.to[1] == 2 && point.clearance == 0.5);
    CHECK(point.side == MINVAR_RIGHT && duct(0)[1].data().from[0] == 6 && duct(0)[1].data().to[1] == 0);
    CHECK(duct(0)[0].data().side == MINVAR_LEFT && duct(0)[0].data().from[0] == 0);

    const minvar::Vec corner = {6, -6, 0};
    const auto distance = [&](const Solution &solution) {
        const minvar::Point nearest = Curve(solution.elements).closest(corner);
        return std::hypot(nearest.point[0] - corner[0], nearest.point[1] - corner[1]);
    };
    Solver solver;
    Options options = with_elements(4);
    const Solution free = solver.solve(coving_joints(), false, options);
    for (const double clearance : {0.25, 0.5}) {
        options.obstacles = duct(clearance);
        const Solution &clear = solver.solve(coving_joints(), false, options);
        CHECK(clear.converged() && clear.elements.size() == 8 && clear.report.value > free.report.value);
        NEAR(distance(clear), clearance, 1e-9);
    }
    // No more allocations after the first of a kind, and without obstacles the curve is what it was.
    const std::vector<Joint> joints = coving_joints();
    const minvar::Observer nobody;
    solver.solve(joints, false, options, nobody);
    const std::size_t before = allocations;
    solver.solve(joints, false, options, nobody);
    CHECK(allocations == before);
    options.obstacles.clear();
    CHECK(same(solver.solve(joints, false, options).elements, free.elements));

    options.obstacles = duct(0.25);
    options.obstacles[1] = Obstacle::point(corner, -1, Obstacle::Side::Left);
    try {
        solver.solve(joints, false, options);
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_BAD_OBSTACLE && error.index() == 1);
    }
    options.obstacles = duct(0.25);
    try {
        solver.update(joints, false, options);
        CHECK(!"thrown");
    } catch (const minvar::Error &) {
    }
    CHECK(same(solver.solution().elements, free.elements));
}

void reference_shapes() {
    const std::vector<Joint> joints = coving_joints();
    Options energy = with_elements(2);
    energy.functional = minvar::Functional::Mec;
    const Solution shape = minvar::solve(joints, false, energy);
    Options options = with_elements(2);
    const double fairest = minvar::solve(joints, false, options).report.variation;
    options.reference.elements = shape.elements;
    const Solution kept = minvar::solve(joints, false, options);
    CHECK(kept.converged() && kept.report.value < 1e-9 * shape.report.variation);
    NEAR(kept.report.variation, shape.report.variation, 1e-5);
    options.reference.weight = 0.5;
    const Solution smoothed = minvar::solve(joints, false, options);
    CHECK(smoothed.report.variation < kept.report.variation && smoothed.report.variation > fairest);
    options.reference.elements.pop_back();
    try {
        minvar::solve(joints, false, options);
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_WRONG_ELEMENT_COUNT && error.details().needed == 2);
    }
}

/// Thesis Fig. 4.9: the same data have a curve with a loop and one without.
void several_minima() {
    const std::vector<Joint> joints = {Joint::at({-1.5, 0, 0}).start_tangent({1, 0.1, 0}), Joint::at({-0.5, 0.5, 0}),
                                       Joint::at({0, 1, 0}).start_tangent({-1, 0, 0}).fix_curvature({0, -10, 0}),
                                       Joint::at({0.5, 0.5, 0}), Joint::at({1.5, 0, 0}).start_tangent({1, -0.1, 0})};
    Solver solver;
    const Solution usual = solver.solve(joints, false, with_elements(2));
    const std::vector<Solution> all = solver.minima(joints, 8, false, with_elements(2));
    CHECK(same(solver.solution().elements, usual.elements));
    CHECK(all.size() >= 2);
    for (std::size_t i = 0; i < all.size(); ++i) {
        CHECK(all[i].converged() && all[i].elements.size() == 8 && all[i].records.empty());
        NEAR(Curve(all[i].elements).variation(), all[i].report.variation, 1e-9);
        CHECK(i == 0 || all[i - 1].report.value < all[i].report.value);
    }
    const std::vector<Solution> one = minvar::minima(joints, 1, false, with_elements(2));
    CHECK(one.size() == 1 && !all.empty() && same(one[0].elements, all[0].elements));
    // With an obstacle each minimum has its own number of elements.
    Options options = with_elements(2);
    options.obstacles = duct(0.25);
    const std::vector<Solution> clear = minvar::minima(coving_joints(), 3, false, options);
    CHECK(!clear.empty() && clear[0].elements.size() == clear[0].report.elements && clear[0].elements.size() == 4);
    // The observer stops the search, and its exceptions come through.
    CHECK(minvar::minima(joints, 2, false, {}, [](std::size_t, const minvar::Record &) { return false; }).empty());
    try {
        minvar::minima(joints, 2, false, {}, [](std::size_t, const minvar::Record &) -> bool { throw 7; });
        CHECK(!"thrown");
    } catch (int seven) {
        CHECK(seven == 7);
    }
    try {
        minvar::minima({}, 2);
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_TOO_FEW_JOINTS);
    }
}

void closed_and_cornered() {
    const Solution circle = minvar::solve(
        {Joint::at({5, 0, 0}), Joint::at({0, 5, 0}), Joint::at({-5, 0, 0}), Joint::at({0, -5, 0})}, true,
        with_elements(4));
    CHECK(circle.converged() && circle.elements.size() == 16);
    const Curve curve(circle.elements);
    const double pi = std::acos(-1.0);
    NEAR(curve.length(), 10 * pi, 1e-7);
    NEAR(curve.figures().least_curvature.signed_curvature, 0.2, 1e-4);
    NEAR(curve.figures().largest_curvature.signed_curvature, 0.2, 1e-4);

    const Solution roof =
        minvar::solve({Joint::at({0, 0, 0}), Joint::at({3, 4, 0}).corner(), Joint::at({6, 0, 0})});
    const Curve lines(roof.elements);
    NEAR(lines.length(), 10, 1e-12);
    CHECK(lines.at_length(2.5).tangent[1] > 0.79 && lines.at_length(7.5).tangent[1] < -0.79);
}

void regions() {
    const auto near = [](const double (&a)[3], const double (&b)[3]) {
        return std::fabs(a[0] - b[0]) + std::fabs(a[1] - b[1]) + std::fabs(a[2] - b[2]) < 1e-13;
    };
    const std::vector<Joint> joints = {Joint::at({3, 0, 0}), Joint::at({1, 2, 0}), Joint::at({-2, 1.5, 0}),
                                       Joint::at({-2.5, -1, 0}), Joint::at({0.5, -2.2, 0})};
    const std::vector<minvar_element> egg = minvar::solve(joints, true).elements;

    // One joint moves: two elements change, and they join the rest.
    Solver solver;
    const Region region(egg, 1, 2, true);
    CHECK(same(region.elements(), std::vector<minvar_element>(egg.begin() + 1, egg.begin() + 3)));
    CHECK(same(region.replaced(region.elements()), egg));
    const std::vector<Joint> held = region.hold({Joint::anywhere(), Joint::at({-2, 1.6, 0}), Joint::anywhere()});
    CHECK(solver.update_from(region.elements(), held).converged());
    const Curve edited(region.replaced(solver.solution().elements));
    for (std::size_t i = 0; i < 5; ++i) {
        CHECK(same(edited.elements()[i], egg[i]) == (i < 1 || i > 2));
        const minvar_point end = edited.at(i, 1), start = edited.at((i + 1) % 5, 0);
        CHECK(same(end.point, start.point) && near(end.tangent, start.tangent) && near(end.curvature, start.curvature));
    }
    const double moved[3] = {-2, 1.6, 0};
    CHECK(same(edited.elements()[1].rows[5], moved));
    // What update_from() refuses leaves the solution.
    const std::vector<minvar_element> before = solver.solution().elements;
    try {
        solver.update_from({}, held);
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_RESULT_TOO_SHORT && same(solver.solution().elements, before));
    }

    // Past the last element, with a joint more.
    const Region around(egg, 4, 2, true);
    const std::vector<minvar_element> two = around.elements();
    CHECK(same(two[0], egg[4]) && same(two[1], egg[0]));
    solver.solve(around.hold({joints[4], Joint::at({2.2, -1.5, 0}), joints[0], joints[1]}));
    const Curve longer(around.replaced(solver.solution().elements));
    CHECK(longer.elements().size() == 6 && same(longer.elements()[0], egg[1]) && same(longer.elements()[2], egg[3]));
    for (std::size_t i = 0; i < 6; ++i) {
        const minvar_point end = longer.at(i, 1), start = longer.at((i + 1) % 6, 0);
        CHECK(same(end.point, start.point) && near(end.tangent, start.tangent) && near(end.curvature, start.curvature));
    }

    // At an open curve's own end, and a joint held at any place.
    const std::vector<Joint> open = Region(egg, 0, 2).hold({joints[0], joints[1], joints[2]});
    CHECK(same(open[0].data(), joints[0].data()) && open[2].data().curvature[0].given == MINVAR_FIXED);
    const minvar_point place = edited.at(3, 0.25);
    const minvar_joint there = Joint::held_at(place).data();
    CHECK(same(there.position.value, place.point) && there.position.given == MINVAR_FIXED);
    CHECK(same(there.tangent[0].value, place.tangent) && there.tangent[1].given == MINVAR_FIXED);
    CHECK(near(there.curvature[1].value, place.curvature) && there.curvature[1].given == MINVAR_FIXED);
    for (const bool closed : {false, true}) {
        try {
            Region(egg, 4, closed ? 6 : 2, closed);
            CHECK(!"thrown");
        } catch (const minvar::Error &error) {
            CHECK(error.code() == MINVAR_BAD_REGION && error.index() == 4 && error.details().given == 5);
        }
    }
}

void measuring() {
    const Curve curve(minvar::solve(coving_joints(), false, with_elements(8)).elements);
    const minvar_element *elements = curve.elements().data();
    const std::size_t count = curve.elements().size();
    minvar_figures figures;
    WORKS(minvar_measure(elements, count, &figures, e));
    CHECK(same(curve.figures(), figures));
    CHECK(curve.length() == figures.length && curve.variation() == figures.variation);
    CHECK(length_in_another_unit(curve) == figures.length);
    minvar_point point;
    WORKS(minvar_point_at(elements, count, 3, 0.25, &point, e));
    CHECK(same(curve.at(3, 0.25), point));
    WORKS(minvar_point_at_length(elements, count, 7.5, &point, e));
    CHECK(same(curve.at_length(7.5), point) && std::fabs(point.arc_length - 7.5) < 1e-12);
    WORKS(minvar_closest_point(elements, count, 6, -6, 0, &point, e));
    CHECK(same(curve.closest({6, -6, 0}), point));
    try {
        curve.at(8, 0.5);
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_OUT_OF_RANGE);
    }
    try {
        Curve({}).length();
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_NO_ELEMENTS);
    }

    double bezier[6][3];
    WORKS(minvar_element_bezier(&elements[2], &bezier, e));
    const std::array<minvar::Vec, 6> ours = curve.bezier(2);
    CHECK(std::memcmp(ours.data(), bezier, sizeof bezier) == 0);
    try {
        curve.bezier(8);
        CHECK(!"thrown");
    } catch (const std::out_of_range &) {
    }
    std::size_t control_count = 0, knot_count = 0;
    WORKS(minvar_bspline_len(elements, count, &control_count, &knot_count, e));
    const minvar::BSpline spline = curve.bspline();
    CHECK(spline.controls.size() == control_count && spline.knots.size() == knot_count);
    CHECK(control_count == 34 && knot_count == 40);
    double controls[34][3], knots[40];
    WORKS(minvar_bspline(elements, count, controls, 34, knots, 40, e));
    CHECK(std::memcmp(spline.controls.data(), controls, sizeof controls) == 0);
    CHECK(std::memcmp(spline.knots.data(), knots, sizeof knots) == 0);
    CHECK((spline.controls.front() == minvar::Vec{0.5, -12, 0} && spline.controls.back() == minvar::Vec{20, -0.5, 0}));
}

extern "C" {
static int32_t keep_move(void *moves, const minvar_move *step) {
    static_cast<std::vector<minvar_move> *>(moves)->push_back(*step);
    return 0;
}
static int32_t keep_text(void *text, const char *piece, size_t length) {
    static_cast<std::string *>(text)->append(piece, length);
    return 0;
}
}

bool equal(const std::vector<minvar_move> &a, const std::vector<minvar_move> &b) {
    bool all = a.size() == b.size();
    for (std::size_t i = 0; all && i < a.size(); ++i) {
        all = a[i].turn == b[i].turn && same(a[i].end, b[i].end) && same(a[i].centre, b[i].centre) &&
              a[i].deviation == b[i].deviation;
    }
    return all;
}

// Takes so many characters, then no more.
class ShortBuffer : public std::streambuf {
public:
    explicit ShortBuffer(std::size_t room) : room_(room) {}

private:
    int_type overflow(int_type character) override {
        return room_-- > 0 ? traits_type::not_eof(character) : traits_type::eof();
    }
    std::size_t room_;
};

void paths() {
    const Curve curve(minvar::solve(coving_joints(), false, with_elements(8)).elements);
    const minvar_element *elements = curve.elements().data();
    const std::size_t count = curve.elements().size();
    std::vector<minvar_move> moves;
    WORKS(minvar_chords(elements, count, 1e-3, keep_move, &moves, e));
    CHECK(equal(curve.chords(1e-3), moves) && moves.size() > 10);
    moves.clear();
    WORKS(minvar_arcs(elements, count, 1e-3, keep_move, &moves, e));
    CHECK(equal(curve.arcs(1e-3), moves) && moves.size() > 3);
    try {
        curve.arcs(0);
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_BAD_TOLERANCE);
    }

    const GcodeOptions options(1e-3, 40, 2);
    const minvar_gcode_options theirs = minvar_gcode_defaults(1e-3, 40, 2);
    std::string text;
    minvar_gcode_summary summary;
    WORKS(minvar_write_gcode(elements, count, &theirs, keep_text, &text, &summary, e));
    CHECK(curve.gcode(options) == text && text.size() > 100);
    std::ostringstream out;
    CHECK(same(curve.write_gcode(out, options), summary));
    CHECK(out.str() == text);

    ShortBuffer tight(100);
    std::ostream paper(&tight);
    try {
        curve.write_gcode(paper, options);
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_STOPPED && paper.bad());
    }
    ShortBuffer tighter(50);
    std::ostream loud(&tighter);
    loud.exceptions(std::ios::badbit);
    try {
        curve.write_gcode(loud, options);
        CHECK(!"thrown");
    } catch (const std::ios::failure &) {
    }
    std::ostringstream empty;
    try {
        curve.write_gcode(empty, GcodeOptions(1e-3, 0, 2));
        CHECK(!"thrown");
    } catch (const minvar::Error &error) {
        CHECK(error.code() == MINVAR_BAD_FEED && empty.str().empty());
    }
}

}  // namespace

int main() {
    try {
        joints();
        options();
        solving();
        obstacles();
        reference_shapes();
        several_minima();
        closed_and_cornered();
        regions();
        measuring();
        paths();
    } catch (const std::exception &error) {
        failures++;
        std::printf("not expected: %s\n", error.what());
    }
    return verdict();
}

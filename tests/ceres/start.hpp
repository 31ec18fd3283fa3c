// The start of thesis 4.9: tangents (4.10), circle curvatures, the end rule, chord lengths. Always in space; a planar curve
// has z = 0.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "element.hpp"
#include "reference.h"

namespace reference {

using V3 = Vec<3, double>;

inline V3 v3(const double* p) { return {p[0], p[1], p[2]}; }
inline V3 sum(const V3& a, const V3& b, double s = 1) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }
inline V3 times(const V3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double inner(const V3& a, const V3& b) { return dot<3, double>(a, b); }
inline V3 outer(const V3& a, const V3& b) { return cross<3, double>(a, b); }
inline double size(const V3& a) { return std::sqrt(inner(a, a)); }
inline V3 unit(const V3& a) { return times(a, 1 / size(a)); }
inline V3 normal_part(const V3& a, const V3& t) { return sum(a, t, -inner(a, t)); }

// What a joint shows to one of its sides.
struct Side {
    V3 tangent{}, curvature{};
    bool has_tangent = false, has_curvature = false;
};

struct JointStart {
    Side in, out;
};

inline size_t span_count(const reference_problem& problem) {
    return problem.closed ? problem.joint_count : problem.joint_count - 1;
}

inline void check(const reference_problem& problem) {
    const auto fail = [](size_t i, const std::string& what) {
        throw std::invalid_argument("joint " + std::to_string(i) + ": " + what);
    };
    if (!problem.joints || problem.joint_count < 2) throw std::invalid_argument("a curve needs two joints or more");
    if (problem.elements_per_span < 1) throw std::invalid_argument("a span needs one element or more");
    if (problem.points < 2) throw std::invalid_argument("an element needs two quadrature points or more");
    if (problem.functional < REFERENCE_MVC || problem.functional > REFERENCE_SI_MVC)
        throw std::invalid_argument("the functional is MVC, MEC or SI-MVC");
    for (size_t i = 0; i < problem.joint_count; ++i) {
        const reference_joint& j = problem.joints[i];
        const V3 t = v3(j.tangent), k = v3(j.curvature);
        if (j.position_status == REFERENCE_FREE) fail(i, "a position is initial or fixed");
        if (j.tangent_status != REFERENCE_FREE && !(size(t) > 0)) fail(i, "the tangent has no direction");
        if (j.curvature_status == REFERENCE_FIXED) {
            if (j.tangent_status == REFERENCE_FIXED && std::fabs(inner(k, unit(t))) > 1e-9 * size(k))
                fail(i, "the fixed curvature is not normal to the fixed tangent");
            if (j.tangent_status == REFERENCE_FREE && size(k) > 0)
                fail(i, "a fixed curvature needs a tangent, initial or fixed, to tell its side");
        }
        if (problem.planar && (j.position[2] != 0 || (j.tangent_status && t[2] != 0) || (j.curvature_status && k[2] != 0)))
            fail(i, "a planar curve has z = 0");
        const size_t next = i + 1 < problem.joint_count ? i + 1 : 0;
        if ((next || problem.closed) && !(size(sum(v3(problem.joints[next].position), v3(j.position), -1)) > 0))
            fail(i, "the next joint is at the same point");
    }
}

// The curvature of the circle through three points, given the tangent at the middle one: perpendicular to the tangent, in
// their plane.
inline V3 circle_curvature(const V3& before, const V3& at, const V3& after, const V3& tangent) {
    const V3 a = sum(at, before, -1), b = sum(after, at, -1), c = sum(after, before, -1);
    const V3 binormal = outer(a, b);
    const double twice_area = size(binormal);
    const double kappa = 2 * twice_area / (size(a) * size(b) * size(c));
    const V3 direction = outer(binormal, tangent);
    // Straight on, or a tangent along the plane's normal, which says nothing about a side.
    if (!(twice_area > 1e-14 * size(a) * size(b)) || !(size(direction) > 1e-9 * twice_area)) return V3{};
    return times(unit(direction), kappa);
}

// A circle leaves a chord as it entered it: reflect about the plane through the chord's middle, and reverse.
inline V3 reflected_tangent(const V3& tangent, const V3& chord) {
    return unit(sum(times(chord, 2 * inner(tangent, chord)), tangent, -1));
}
inline V3 reflected_curvature(const V3& curvature, const V3& chord) {
    return sum(curvature, chord, -2 * inner(curvature, chord));
}

inline std::vector<JointStart> start_joints(const reference_problem& problem) {
    const size_t n = problem.joint_count;
    const auto at = [&](size_t i) { return v3(problem.joints[i % n].position); };
    std::vector<JointStart> start(n);
    // An open end, and each side of a corner, has one neighbour only.
    const auto corner = [&](size_t i) { return problem.joints[i].continuity == 0; };
    const auto has_before = [&](size_t i) { return problem.closed || i > 0; };
    const auto has_after = [&](size_t i) { return problem.closed || i + 1 < n; };
    for (size_t i = 0; i < n; ++i) {
        const reference_joint& j = problem.joints[i];
        Side side;
        const bool interior = has_before(i) && has_after(i);
        V3 a{}, b{};
        if (interior) {
            a = sum(at(i), at(i + n - 1), -1);
            b = sum(at(i + 1), at(i), -1);
        }
        if (j.tangent_status != REFERENCE_FREE) {
            side.tangent = unit(v3(j.tangent));
            side.has_tangent = true;
        } else if (interior && !corner(i)) {
            V3 t = sum(times(a, 1 / inner(a, a)), b, 1 / inner(b, b));
            if (!(size(t) * size(a) > 1e-9)) t = b;  // straight back: any side is as good
            side.tangent = unit(t);
            side.has_tangent = true;
        }
        if (j.curvature_status != REFERENCE_FREE && side.has_tangent) {
            const V3 given = v3(j.curvature), k = normal_part(given, side.tangent);
            side.curvature = size(k) > 0 ? times(unit(k), size(given)) : V3{};
            side.has_curvature = true;
        } else if (interior && !corner(i) && side.has_tangent) {
            side.curvature = circle_curvature(at(i + n - 1), at(i), at(i + 1), side.tangent);
            side.has_curvature = true;
        }
        start[i] = {side, side};
    }
    // What is still open takes its neighbour's value; two open neighbours take the chord.
    const std::vector<JointStart> known = start;
    const auto complete = [](Side& mine, const Side& other, const V3& chord) {
        if (!mine.has_tangent) mine.tangent = other.has_tangent ? reflected_tangent(other.tangent, chord) : chord;
        if (!mine.has_curvature && other.has_curvature)
            mine.curvature = normal_part(reflected_curvature(other.curvature, chord), mine.tangent);
    };
    for (size_t s = 0; s < span_count(problem); ++s) {
        const size_t e = (s + 1) % n;
        const V3 chord = unit(sum(at(e), at(s), -1));
        complete(start[s].out, known[e].in, chord);
        complete(start[e].in, known[s].out, chord);
    }
    if (!problem.closed) {
        start[0].in = start[0].out;
        start[n - 1].out = start[n - 1].in;
    }
    return start;
}

// Value and derivatives of one element, as its rows scaled to a piece [t0, t1] of it.
inline Rows<3, double> piece(const Rows<3, double>& rows, double t0, double t1) {
    const double h = t1 - t0;
    Rows<3, double> r;
    r[0] = combine<3, double>(rows, blending(0, t0));
    r[1] = times(combine<3, double>(rows, blending(1, t0)), h);
    r[2] = times(combine<3, double>(rows, blending(2, t0)), h * h);
    r[3] = times(combine<3, double>(rows, blending(2, t1)), h * h);
    r[4] = times(combine<3, double>(rows, blending(1, t1)), h);
    r[5] = combine<3, double>(rows, blending(0, t1));
    return r;
}

// One element a span by the rules, cut into equal pieces of the parameter (the thesis leaves inserted joints open).
inline std::vector<Rows<3, double>> start_rows(const reference_problem& problem) {
    const auto joints = start_joints(problem);
    std::vector<Rows<3, double>> elements;
    const int pieces = problem.elements_per_span;
    for (size_t s = 0; s < span_count(problem); ++s) {
        const size_t e = (s + 1) % problem.joint_count;
        const V3 a = v3(problem.joints[s].position), b = v3(problem.joints[e].position);
        const double speed = size(sum(b, a, -1));
        const Side &from = joints[s].out, &to = joints[e].in;
        const Rows<3, double> rows = {a,
                                      times(from.tangent, speed),
                                      times(from.curvature, speed * speed),
                                      times(to.curvature, speed * speed),
                                      times(to.tangent, speed),
                                      b};
        for (int i = 0; i < pieces; ++i) elements.push_back(piece(rows, double(i) / pieces, double(i + 1) / pieces));
    }
    return elements;
}

}  // namespace reference

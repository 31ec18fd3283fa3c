// OpenCASCADE's FairCurve_MinimalVariation between a case's two points.
//
//   case ...                 takes a case; answers the number of its points
//   solve SLIDING            the analysis code (0 is OK, 100 more if nothing was computed), V, and the ends' largest errors:
//                            of a point, of a direction, of a fixed curvature
//   time SLIDING SECONDS     microseconds to construct and compute
//
// SLIDING is "default" (the length is imposed by the sliding factor 1) or "free".
#include <cmath>

#include <FairCurve_AnalysisCode.hxx>
#include <FairCurve_MinimalVariation.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <gp_Pnt2d.hxx>
#include <gp_Vec2d.hxx>

#include "peer.hpp"

namespace peer {
namespace {

gp_Pnt2d point(const Joint& joint) { return {joint.point[0], joint.point[1]}; }
gp_Vec2d vector(const Vector& v) { return {v[0], v[1]}; }

// The signed curvature of a tangent and a curvature vector: positive to the left.
double signed_curvature(const gp_Vec2d& tangent, const gp_Vec2d& curvature) {
    return tangent.Crossed(curvature) / tangent.Magnitude();
}

struct Answer {
    bool done;
    FairCurve_AnalysisCode code;
    Handle(Geom2d_BSplineCurve) curve;
};

Answer solve(const Case& data, bool free) {
    const Joint &first = data.joints[0], &last = data.joints[1];
    const gp_Vec2d chord(point(first), point(last));
    // A batten a twentieth as high as its chord is long: with a whole chord or none at all it fails on some of the cases.
    FairCurve_MinimalVariation batten(point(first), point(last), chord.Magnitude() / 20);
    batten.SetFreeSliding(free);
    // Both angles are measured from the chord into the curve, so that an arc has two equal ones.
    batten.SetAngle1(chord.Angle(vector(first.tangent.value)));
    batten.SetAngle2(vector(last.tangent.value).Angle(chord));
    if (first.curvature.fixed) {
        batten.SetConstraintOrder1(2);
        batten.SetCurvature1(signed_curvature(vector(first.tangent.value), vector(first.curvature.value)));
    }
    if (last.curvature.fixed) {
        batten.SetConstraintOrder2(2);
        batten.SetCurvature2(signed_curvature(vector(last.tangent.value), vector(last.curvature.value)));
    }
    Answer answer{};
    answer.done = batten.Compute(answer.code);
    answer.curve = batten.Curve();
    return answer;
}

double variation(const Geom2d_BSplineCurve& curve, const std::vector<Node>& rule) {
    constexpr int kParts = 8;
    double sum = 0;
    for (int knot = curve.FirstUKnotIndex(); knot < curve.LastUKnotIndex(); ++knot) {
        const double part = (curve.Knot(knot + 1) - curve.Knot(knot)) / kParts;
        for (int k = 0; k < kParts; ++k)
            for (const Node& node : rule) {
                gp_Pnt2d p;
                gp_Vec2d d1, d2, d3;
                curve.D3(curve.Knot(knot) + part * (k + node.t), p, d1, d2, d3);
                const double square = d1.SquareMagnitude(), speed = std::sqrt(square);
                const double slope =
                    (d1.Crossed(d3) - 3 * d1.Crossed(d2) * d1.Dot(d2) / square) / (square * square);
                sum += part * node.weight * slope * slope * speed;
            }
    }
    return sum;
}

void report(const Case& data, const Answer& answer) {
    print(answer.done ? double(answer.code) : 100 + double(answer.code));
    print(variation(*answer.curve, data.rule));
    double errors[3]{};
    for (int end = 0; end < 2; ++end) {
        const Joint& joint = data.joints[end];
        gp_Pnt2d p;
        gp_Vec2d d1, d2;
        answer.curve->D2(end ? answer.curve->LastParameter() : answer.curve->FirstParameter(), p, d1, d2);
        errors[0] = std::max(errors[0], p.Distance(point(joint)));
        errors[1] = std::max(errors[1], std::fabs(d1.Angle(vector(joint.tangent.value))));
        if (joint.curvature.fixed) {
            const double found = d1.Crossed(d2) / std::pow(d1.Magnitude(), 3);
            const double wanted = signed_curvature(vector(joint.tangent.value), vector(joint.curvature.value));
            errors[2] = std::max(errors[2], std::fabs(found - wanted));
        }
    }
    for (double error : errors) print(error);
}

}  // namespace
}  // namespace peer

int main() {
    using namespace peer;
    Case data;
    return serve([&](const std::string& command) {
        if (command == "case") {
            data = read_case(std::cin);
            if (data.joints.size() != 2 || data.dimension != 2) throw std::runtime_error("two points in the plane, no more");
            print(double(data.joints.size()));
            return;
        }
        std::string sliding;
        std::cin >> sliding;
        if (sliding != "free" && sliding != "default") throw std::runtime_error("no sliding " + sliding);
        const bool free = sliding == "free";
        if (command == "solve") {
            report(data, solve(data, free));
        } else if (command == "time") {
            double seconds;
            std::cin >> seconds;
            print(microseconds(seconds, [&] { solve(data, free); }));
        } else {
            throw std::runtime_error("no command " + command);
        }
    });
}

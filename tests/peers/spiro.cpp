// libspiro through a case's points: the interpolating spline of Euler spirals ("g2", curvature linear in the arc length) and
// the smoother one that libspiro calls G4 ("g4", curvature cubic in the arc length).
//
//   case ...              takes a case; answers the number of its points
//   solve KIND            V, then the largest breaks at points: of the direction, of the curvature and of its derivative, the
//                         last two without unit by the mean length of a segment. Nothing if libspiro gives up.
//   time KIND SECONDS     microseconds to find the spiral, and to find it and write it as Bezier curves
#include <cmath>
#include <memory>

#include <spiroentrypoints.h>

#include "peer.hpp"

namespace peer {
namespace {

using Spiral = std::unique_ptr<spiro_seg, decltype(&free_spiro)>;

// Takes Bezier curves and forgets them.
struct Sink : bezctx {
    Sink() : bezctx{} {
        moveto = [](bezctx*, double, double, int) {};
        lineto = [](bezctx*, double, double) {};
        quadto = [](bezctx*, double, double, double, double) {};
        curveto = [](bezctx*, double, double, double, double, double, double) {};
        mark_knot = [](bezctx*, int) {};
    }
};

// The curvature is k0 + k1 s + k2 s^2/2 + k3 s^3/6 for s from -1/2 to 1/2 along a segment of length 1.
double curvature(const double* k, double s) { return k[0] + s * (k[1] + s * (k[2] / 2 + s * k[3] / 6)); }
double slope(const double* k, double s) { return k[1] + s * (k[2] + s * k[3] / 2); }
double angle(const double* k, double s) { return s * (k[0] + s * (k[1] / 2 + s * (k[2] / 6 + s * k[3] / 24))); }

// What a segment shows at an end: direction, curvature, its derivative by arc length.
struct Shape {
    double direction, curvature, slope;
};

class Points {
   public:
    Points(const Case& data, char type) : rule_(data.rule) {
        if (data.closed || data.dimension != 2) throw std::runtime_error("spirals are for open plane curves here");
        for (const Joint& joint : data.joints) points_.push_back({joint.point[0], joint.point[1], type});
        points_.front().ty = SPIRO_OPEN_CONTOUR;
        points_.back().ty = SPIRO_END_OPEN_CONTOUR;
    }

    Spiral spiral() const {
        double place[6];
        return Spiral(run_spiro0(points_.data(), place, 0, int(points_.size())), free_spiro);
    }

    bool beziers() const {
        Sink sink;
        return TaggedSpiroCPsToBezier2(const_cast<spiro_cp*>(points_.data()), 0, &sink);
    }

    void measure(const spiro_seg* segments) const {
        double v = 0, total = 0;
        std::vector<std::array<Shape, 2>> shapes;
        for (size_t i = 0; i + 1 < points_.size(); ++i) {
            const double* k = segments[i].ks;
            double x = 0, y = 0;
            for (const Node& node : rule_) {
                x += node.weight * std::cos(angle(k, node.t - 0.5));
                y += node.weight * std::sin(angle(k, node.t - 0.5));
            }
            const double dx = points_[i + 1].x - points_[i].x, dy = points_[i + 1].y - points_[i].y;
            const double length = std::hypot(dx, dy) / std::hypot(x, y);
            total += length;
            v += (k[1] * k[1] + (k[2] * k[2] + k[1] * k[3]) / 12 + k[3] * k[3] / 320) / (length * length * length);
            const auto shape = [&](double s) {
                return Shape{std::atan2(dy, dx) - std::atan2(y, x) + angle(k, s), curvature(k, s) / length,
                             slope(k, s) / (length * length)};
            };
            shapes.push_back({shape(-0.5), shape(0.5)});
        }
        Shape breaks{};
        const double mean = total / double(shapes.size());
        for (size_t i = 1; i < shapes.size(); ++i) {
            const Shape &before = shapes[i - 1][1], &after = shapes[i][0];
            const double turn = std::remainder(after.direction - before.direction, 2 * M_PI);
            breaks.direction = std::max(breaks.direction, std::fabs(turn));
            breaks.curvature = std::max(breaks.curvature, mean * std::fabs(after.curvature - before.curvature));
            breaks.slope = std::max(breaks.slope, mean * mean * std::fabs(after.slope - before.slope));
        }
        print(v);
        print(breaks.direction);
        print(breaks.curvature);
        print(breaks.slope);
    }

   private:
    std::vector<Node> rule_;
    std::vector<spiro_cp> points_;
};

char type_of(const std::string& kind) {
    if (kind == "g4") return SPIRO_G4;
    if (kind == "g2") return SPIRO_G2;
    throw std::runtime_error("no kind of spiral " + kind);
}

}  // namespace
}  // namespace peer

int main() {
    using namespace peer;
    Case data;
    return serve([&](const std::string& command) {
        if (command == "case") {
            data = read_case(std::cin);
            print(double(data.joints.size()));
            return;
        }
        std::string kind;
        std::cin >> kind;
        const Points points(data, type_of(kind));
        if (command == "solve") {
            if (const Spiral spiral = points.spiral()) points.measure(spiral.get());
        } else if (command == "time") {
            double seconds;
            std::cin >> seconds;
            print(microseconds(seconds, [&] { points.spiral(); }));
            print(microseconds(seconds, [&] { points.beziers(); }));
        } else {
            throw std::runtime_error("no command " + command);
        }
    });
}

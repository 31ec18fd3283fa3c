// libspiro on problems from the standard input: points only, planar.
//
// A line in:  NUMBER CLOSED COUNT x y x y ...
// A line out: NUMBER SUCCESS MICROSECONDS COUNT x y x y ...   the control points of its cubics in a row, the first point once
#include <spiroentrypoints.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

// libspiro draws through callbacks on a structure that begins with its own.
struct Cubics {
    bezctx base;
    std::vector<double> points;
};

std::vector<double>& points(bezctx* context) { return reinterpret_cast<Cubics*>(context)->points; }

void add(bezctx* context, double x, double y) {
    points(context).push_back(x);
    points(context).push_back(y);
}

void moveto(bezctx* context, double x, double y, int) { add(context, x, y); }

void curveto(bezctx* context, double x1, double y1, double x2, double y2, double x3, double y3) {
    add(context, x1, y1);
    add(context, x2, y2);
    add(context, x3, y3);
}

void lineto(bezctx* context, double x, double y) {
    const std::vector<double>& so_far = points(context);
    const double x0 = so_far[so_far.size() - 2], y0 = so_far[so_far.size() - 1];
    curveto(context, x0 + (x - x0) / 3, y0 + (y - y0) / 3, x0 + 2 * (x - x0) / 3, y0 + 2 * (y - y0) / 3, x, y);
}

void quadto(bezctx* context, double x1, double y1, double x, double y) {
    const std::vector<double>& so_far = points(context);
    const double x0 = so_far[so_far.size() - 2], y0 = so_far[so_far.size() - 1];
    curveto(context, x0 + 2 * (x1 - x0) / 3, y0 + 2 * (y1 - y0) / 3, x + 2 * (x1 - x) / 3, y + 2 * (y1 - y) / 3, x, y);
}

void knot(bezctx*, int) {}

}  // namespace

int main() {
    std::string line;
    while (std::getline(std::cin, line)) {
        std::istringstream in(line);
        long number = 0;
        int closed = 0;
        std::size_t count = 0;
        in >> number >> closed >> count;
        std::vector<spiro_cp> spiros(count);
        for (spiro_cp& point : spiros) {
            in >> point.x >> point.y;
            point.ty = SPIRO_G4;
        }
        if (closed) {
            spiros.push_back({0, 0, SPIRO_END});
        } else {
            spiros.front().ty = SPIRO_OPEN_CONTOUR;
            spiros.back().ty = SPIRO_END_OPEN_CONTOUR;
        }
        Cubics cubics{{moveto, lineto, quadto, curveto, knot}, {}};
        const auto start = std::chrono::steady_clock::now();
        const int success = TaggedSpiroCPsToBezier0(spiros.data(), &cubics.base);
        const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
        std::printf("%ld %d %.3f %zu", number, success, time.count(), cubics.points.size() / 2);
        for (double x : cubics.points) std::printf(" %.17g", x);
        std::printf("\n");
    }
}

// OpenCASCADE's FairCurve_MinimalVariation on problems from the standard input: two points with end tangents, planar.
//
// A line in:  NUMBER x0 y0 angle0 x1 y1 angle1      angles of the tangents with the x axis
// A line out: NUMBER CODE MICROSECONDS COUNT x y x y ...   the poles of its one Bezier span; code 0 is OK, -1 an exception
#include <FairCurve_MinimalVariation.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Standard_Failure.hxx>
#include <gp_Pnt2d.hxx>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

int main() {
    std::string line;
    while (std::getline(std::cin, line)) {
        std::istringstream in(line);
        long number = 0;
        double x0 = 0, y0 = 0, angle0 = 0, x1 = 0, y1 = 0, angle1 = 0;
        in >> number >> x0 >> y0 >> angle0 >> x1 >> y1 >> angle1;
        const double chord = std::atan2(y1 - y0, x1 - x0), turn = 8 * std::atan(1.0);
        int code = -1;
        Handle(Geom2d_BSplineCurve) curve;
        const auto start = std::chrono::steady_clock::now();
        try {
            // The height of the batten scales nothing where the energy is that of the jerk alone.
            FairCurve_MinimalVariation batten(gp_Pnt2d(x0, y0), gp_Pnt2d(x1, y1), 1.0);
            // Angles from the chord; the second one to the other side.
            batten.SetAngle1(std::remainder(angle0 - chord, turn));
            batten.SetAngle2(std::remainder(chord - angle1, turn));
            batten.SetFreeSliding(Standard_True);
            FairCurve_AnalysisCode analysis = FairCurve_NotConverged;
            batten.Compute(analysis, 100, 1e-6);
            code = analysis;
            curve = batten.Curve();
        } catch (const Standard_Failure&) {
            code = -1;
        }
        const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
        // More than one span would not be a Bezier curve's poles.
        const int count = curve.IsNull() || curve->NbKnots() != 2 ? 0 : curve->NbPoles();
        std::printf("%ld %d %.3f %d", number, code, time.count(), count);
        for (int i = 1; i <= count; ++i) std::printf(" %.17g %.17g", curve->Pole(i).X(), curve->Pole(i).Y());
        std::printf("\n");
    }
}

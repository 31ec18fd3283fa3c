// A way to solve a case.
#pragma once

#include <map>
#include <memory>
#include <string>

namespace peer {

struct Variant {
    virtual ~Variant() = default;
    // Prints the microseconds it took, the number of iterations, and each iteration after which the sum of squares was lower
    // than before with the sum.
    virtual void history(int most) = 0;
    // Prints the sum after at most so many iterations, and the rows.
    virtual void solve(int most) = 0;
    // Prints the microseconds to solve, and to build the problem and solve.
    virtual void time(int most, double seconds) = 0;
};

// The first radii of the trust region that are tried: what Ceres starts with, and one that suits these problems more often.
constexpr double kRadii[] = {1e4, 1e2};
inline std::string radius_name(double radius) { return radius == kRadii[0] ? "1e4" : "1e2"; }

using Variants = std::map<std::string, std::unique_ptr<Variant>>;

}  // namespace peer

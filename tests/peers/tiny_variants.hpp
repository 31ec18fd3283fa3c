// Ceres's TinySolver, with the sizes of the case compiled in or not.
#pragma once

#include <ceres/tiny_solver.h>

#include "curve.hpp"
#include "variant.hpp"

namespace peer {

template <int N>
constexpr std::integral_constant<int, N> kSize{};

template <int D, bool Thesis, int Residuals, int Unknowns>
struct TinyFunction {
    using Scalar = double;
    enum { NUM_RESIDUALS = Residuals, NUM_PARAMETERS = Unknowns };

    const Curve<D, Thesis>& curve;
    Derivatives how;
    // If there, a trial is noted with its iteration, and with the sum where it is accepted.
    std::vector<std::pair<int, double>>* history = nullptr;

    int NumResiduals() const { return curve.residuals(); }
    int NumParameters() const { return curve.unknowns(); }

    bool operator()(const double* x, double* residuals, double* jacobian) const {
        const int m = curve.residuals();
        const bool inside = curve.evaluate(x, residuals, jacobian, how);
        // TinySolver does not look at what a function returns. This is refused as far too large.
        if (!inside) std::fill_n(residuals, m, 1e50);
        if (history) {
            if (!jacobian) {
                history->push_back({history->back().first + 1, history->back().second});
            } else {
                double sum = 0;
                for (int i = 0; i < m; ++i) sum += residuals[i] * residuals[i];
                if (history->empty()) history->push_back({0, sum});
                history->back().second = sum;
            }
        }
        return inside;
    }
};

template <int D, bool Thesis, int Residuals, int Unknowns>
class TinyVariant : public Variant {
   public:
    using Function = TinyFunction<D, Thesis, Residuals, Unknowns>;
    using Solver = ceres::TinySolver<Function>;

    TinyVariant(const Curve<D, Thesis>& curve, Derivatives how, double radius)
        : curve_(curve), function_{curve, how}, radius_(radius) {}

    void history(int most) override {
        std::vector<std::pair<int, double>> history;
        Function noting = function_;
        noting.history = &history;
        print(microseconds(0, [&] { run(*solver(), noting, most); }));
        print(history.back().first);
        double least = std::numeric_limits<double>::infinity();
        for (const auto& [iteration, sum] : history)
            if (sum < least) {
                least = sum;
                print(iteration);
                print(sum);
            }
    }

    void solve(int most) override {
        const auto x = run(*solver(), function_, most);
        print(curve_.value(x.data()));
        curve_.print_rows(x.data());
    }

    void time(int most, double seconds) override {
        const auto kept = solver();
        print(microseconds(seconds, [&] { run(*kept, function_, most); }));
        print(microseconds(seconds, [&] { run(*solver(), function_, most); }));
    }

   private:
    std::unique_ptr<Solver> solver() const {
        auto solver = std::make_unique<Solver>();
        auto& o = solver->options;
        o.gradient_tolerance = o.parameter_tolerance = o.function_tolerance = o.cost_threshold = 0;
        o.initial_trust_region_radius = radius_;
        return solver;
    }

    typename Solver::Parameters run(Solver& solver, const Function& function, int most) const {
        typename Solver::Parameters x = Eigen::Map<const Eigen::VectorXd>(curve_.start.data(), curve_.unknowns());
        // It counts from one, and stops before the last.
        solver.options.max_num_iterations = most + 1;
        solver.Solve(function, &x);
        return x;
    }

    const Curve<D, Thesis>& curve_;
    Function function_;
    double radius_;
};

template <int Residuals, int Unknowns, int D, bool Thesis>
bool add_tiny_of(const char* name, const Curve<D, Thesis>& curve, Derivatives how, const std::string& suffix, Variants& to) {
    if (Residuals != Eigen::Dynamic && (curve.residuals() != Residuals || curve.unknowns() != Unknowns)) return false;
    for (const double radius : kRadii)
        to[name + ("/lm" + radius_name(radius)) + suffix] =
            std::make_unique<TinyVariant<D, Thesis, Residuals, Unknowns>>(curve, how, radius);
    return true;
}

// Sizes that are compiled in: those of the cases but the largest, which Eigen would not put on the stack.
template <int D, bool Thesis>
void add_tiny(const Curve<D, Thesis>& curve, Derivatives how, const std::string& suffix, Variants& to) {
    add_tiny_of<Eigen::Dynamic, Eigen::Dynamic>("tiny_dynamic", curve, how, suffix, to);
    const auto fixed = [&](auto residuals, auto unknowns) {
        return add_tiny_of<residuals(), unknowns()>("tiny_fixed", curve, how, suffix, to);
    };
    if constexpr (D == 2) {
        fixed(kSize<32>, kSize<5>) || fixed(kSize<32>, kSize<6>) || fixed(kSize<64>, kSize<12>) ||
            fixed(kSize<128>, kSize<25>) || fixed(kSize<256>, kSize<32>) || fixed(kSize<192>, kSize<38>) ||
            fixed(kSize<256>, kSize<48>);
    } else {
        fixed(kSize<192>, kSize<14>);
    }
}

}  // namespace peer

// Ceres's trust region solver with its linear solvers.
#pragma once

#include <memory>
#include <string>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include "curve.hpp"
#include "variant.hpp"

namespace peer {

// A residual block an element over the blocks that it touches.
template <int D, bool Thesis>
class ElementCost : public ceres::CostFunction {
   public:
    using Part = typename Curve<D, Thesis>::Part;

    ElementCost(const Part& part, Derivatives how) : part_(part), how_(how) {
        set_num_residuals(part.element.residuals());
        for (const Block& block : part.blocks)
            if (block.size > 0) mutable_parameter_block_sizes()->push_back(block.size);
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        double x[kMostLocal];
        Column columns[kMostLocal];
        int local = 0, b = 0;
        for (const Block& block : part_.blocks) {
            if (block.size == 0) continue;
            double* jacobian = jacobians ? jacobians[b] : nullptr;
            for (int k = 0; k < block.size; ++k, ++local) {
                x[local] = parameters[b][k];
                columns[local] = {jacobian ? jacobian + k : nullptr, block.size};
            }
            ++b;
        }
        return part_.element.evaluate(x, residuals, jacobians ? columns : nullptr, how_);
    }

   private:
    const Part& part_;
    Derivatives how_;
};

template <int D, bool Thesis>
class CeresVariant : public Variant {
   public:
    CeresVariant(const Curve<D, Thesis>& curve, Derivatives how, const ceres::Solver::Options& options)
        : curve_(curve), how_(how), options_(options), x_(curve.start) {}

    void history(int most) override {
        ceres::Solver::Summary summary;
        print(microseconds(0, [&] { summary = run(most); }));
        print(double(summary.iterations.size()) - 1);
        double least = std::numeric_limits<double>::infinity();
        for (const auto& iteration : summary.iterations) {
            if (2 * iteration.cost < least) {
                least = 2 * iteration.cost;
                print(iteration.iteration);
                print(least);
            }
        }
    }

    void solve(int most) override {
        run(most);
        print(curve_.value(x_.data()));
        curve_.print_rows(x_.data());
    }

    void time(int most, double seconds) override {
        const auto problem = build();
        options_.max_num_iterations = most;
        print(microseconds(seconds, [&] {
            std::copy(curve_.start.begin(), curve_.start.end(), x_.begin());
            ceres::Solver::Summary summary;
            ceres::Solve(options_, problem.get(), &summary);
        }));
        print(microseconds(seconds, [&] { run(most); }));
    }

   private:
    std::unique_ptr<ceres::Problem> build() {
        ceres::Problem::Options options;
        options.disable_all_safety_checks = true;
        auto problem = std::make_unique<ceres::Problem>(options);
        for (const auto& part : curve_.parts) {
            double* blocks[3];
            int count = 0;
            for (const Block& block : part.blocks)
                if (block.size > 0) blocks[count++] = x_.data() + block.begin;
            problem->AddResidualBlock(new ElementCost<D, Thesis>(part, how_), nullptr, blocks, count);
        }
        return problem;
    }

    ceres::Solver::Summary run(int most) {
        std::copy(curve_.start.begin(), curve_.start.end(), x_.begin());
        const auto problem = build();
        options_.max_num_iterations = most;
        ceres::Solver::Summary summary;
        ceres::Solve(options_, problem.get(), &summary);
        return summary;
    }

    const Curve<D, Thesis>& curve_;
    Derivatives how_;
    ceres::Solver::Options options_;
    std::vector<double> x_;
};

template <int D, bool Thesis>
void add_ceres(const Curve<D, Thesis>& curve, Derivatives how, const std::string& suffix, Variants& to) {
    ceres::Solver::Options o;
    // The iterations decide when to stop.
    o.function_tolerance = o.gradient_tolerance = o.parameter_tolerance = 0;
    o.max_num_consecutive_invalid_steps = 50;
    o.num_threads = 1;
    o.logging_type = ceres::SILENT;
    // SuiteSparse takes a tenth longer for these sizes; CXSparse is no faster.
    o.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    const auto add = [&](const std::string& name, ceres::LinearSolverType solver) {
        o.linear_solver_type = solver;
        to[name + suffix] = std::make_unique<CeresVariant<D, Thesis>>(curve, how, o);
    };
    o.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
    for (const double radius : kRadii) {
        o.initial_trust_region_radius = radius;
        const std::string strategy = "/lm" + radius_name(radius);
        add("dense_qr" + strategy, ceres::DENSE_QR);
        add("dense_cholesky" + strategy, ceres::DENSE_NORMAL_CHOLESKY);
        add("sparse_cholesky" + strategy, ceres::SPARSE_NORMAL_CHOLESKY);
    }
    o.initial_trust_region_radius = kRadii[0];
    o.trust_region_strategy_type = ceres::DOGLEG;
    add("sparse_cholesky/dogleg", ceres::SPARSE_NORMAL_CHOLESKY);
}

}  // namespace peer

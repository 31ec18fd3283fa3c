// Newton's method with the exact Hessian, dense: a trust region solved exactly in the Hessian's eigenvectors, down to a
// gradient at rounding level. Slow and sure.
#pragma once

#include <cmath>

#include "model.hpp"

namespace reference {

// The Hessian in parameters scaled to one unit each, taken apart.
struct Quadratic {
    double value;
    Eigen::VectorXd gradient;  // scaled
    Eigen::VectorXd raw_gradient;
    Eigen::VectorXd eigenvalues, along;  // along: the scaled gradient's components
    Eigen::MatrixXd eigenvectors;

    template <int D>
    explicit Quadratic(const Model<D>& model) {
        Eigen::MatrixXd h;
        value = model.hessian(raw_gradient, h);
        const Eigen::VectorXd s = model.scale();
        gradient = raw_gradient.cwiseProduct(s);
        h = (s.asDiagonal() * h * s.asDiagonal()).eval();
        if (!h.allFinite()) throw std::invalid_argument("the functional is not finite at the start");
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(h);
        eigenvalues = solver.eigenvalues();
        eigenvectors = solver.eigenvectors();
        along = eigenvectors.transpose() * gradient;
    }

    // Rounding alone makes eigenvalues of this size (rigid motions of an unconstrained curve have none).
    double floor() const { return 1e-15 * double(gradient.size()) * eigenvalues.cwiseAbs().maxCoeff(); }

    double decrement() const {
        double d = 0;
        for (int i = 0; i < along.size(); ++i)
            if (std::fabs(eigenvalues[i]) > floor()) d += 0.5 * along[i] * along[i] / std::fabs(eigenvalues[i]);
        return d;
    }

    // The minimiser of the quadratic inside the ball, in eigenvector components.
    Eigen::VectorXd step(double radius) const {
        const int n = int(along.size());
        const auto shifted = [&](double mu) {
            Eigen::VectorXd s(n);
            for (int i = 0; i < n; ++i) {
                const double lambda = eigenvalues[i] + mu;
                s[i] = lambda > floor() ? -along[i] / lambda : 0;
            }
            return s;
        };
        const double lowest = eigenvalues.minCoeff();
        if (lowest > -floor()) {
            const Eigen::VectorXd s = shifted(0);
            if (s.norm() <= radius) return s;
        }
        double low = std::max(0.0, -lowest), high = low + along.norm() / radius + floor();
        if (lowest < -floor()) {
            // The hard case: the gradient has nothing along the lowest curvature, so go along it to the ball.
            Eigen::VectorXd s = shifted(low + 2 * floor());
            if (s.norm() < radius) {
                s[0] += (along[0] > 0 ? -1 : 1) * std::sqrt(radius * radius - s.squaredNorm());
                return s;
            }
        }
        for (int k = 0; k < 200 && high - low > 1e-14 * high; ++k) {
            const double middle = low > 0 && high < 4 * low ? 0.5 * (low + high) : std::sqrt(std::max(low, 1e-30 * high) * high);
            (shifted(middle).norm() > radius ? low : high) = middle;
        }
        return shifted(high);
    }
};

// Returns the number of iterations. Stops early where the curve runs away.
template <int D>
int newton(Model<D>& model, int limit) {
    if (model.parameter_count() == 0) return 0;
    int iterations = 0;
    double radius = 1;
    Eigen::VectorXd scale = model.scale();
    model.recentre();
    Quadratic q(model);
    int stuck = 0;
    while (iterations < limit && stuck < 30 && !model.runaway()) {
        ++iterations;
        const Eigen::VectorXd components = q.step(radius);
        const double gain = -components.dot(q.along) -
                            0.5 * components.cwiseProduct(components).dot(q.eigenvalues);
        const double length = components.norm();
        if (!(length > 0)) break;
        const Eigen::VectorXd before = model.get();
        model.set(before + (q.eigenvectors * components).cwiseProduct(scale));
        Eigen::VectorXd g;
        const double value = model.gradient(g);
        const double norm = g.cwiseProduct(scale).norm();
        // Where the gain is lost in the values' rounding, the gradient decides.
        const double noise = 1e-15 * (q.value + std::sqrt(q.value * model.natural_value()));
        const bool bottom = gain < 30 * noise;
        const double ratio = (q.value - value) / gain;
        const bool better = std::isfinite(value) && std::isfinite(norm) &&
                            (bottom ? norm < q.gradient.norm() && value < q.value + 30 * noise
                                    : ratio > 1e-4);
        if (!better) {
            model.set(before);
            radius = 0.25 * std::min(radius, length);
            ++stuck;
            // At rounding level a full Newton step that gains nothing is the end.
            if (bottom && length < 1e-7) break;
            continue;
        }
        stuck = 0;
        if (bottom || ratio > 0.75) radius = std::max(radius, 3 * length);
        if (!bottom && ratio < 0.25) radius = 0.25 * length;
        model.recentre();
        q = Quadratic(model);
    }
    return iterations;
}

template <int D>
reference_certificate certify(const Model<D>& model) {
    reference_certificate c{};
    c.parameters = model.parameter_count();
    if (c.parameters == 0) {
        c.value = model.value();
        return c;
    }
    const Quadratic q(model);
    c.value = q.value;
    c.gradient = q.raw_gradient.cwiseAbs().maxCoeff();
    c.decrement = q.decrement();
    c.smallest_eigenvalue = q.eigenvalues.minCoeff();
    c.largest_eigenvalue = q.eigenvalues.maxCoeff();
    return c;
}

}  // namespace reference

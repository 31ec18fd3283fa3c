// The reference solver: Ceres's Levenberg-Marquardt over autodiff residuals, then Newton. The only file that includes Ceres
// whole, and the C boundary of it all.
#include "reference.h"

#include <cstring>
#include <memory>
#include <mutex>

#include <ceres/ceres.h>
#include <glog/logging.h>

#include "newton.hpp"

namespace reference {
namespace {

// sqrt(w |C'|) times the functional's density, one residual a quadrature point and binormal component.
template <int D>
struct Residuals {
    Frame<D> frame0, frame1;
    const std::vector<Sample>* rule;
    bool bending;

    template <class T>
    bool operator()(const T* p0, const T* t0, const T* k0, const T* p1, const T* t1, const T* k1, const T* shape,
                    T* out) const {
        using std::sqrt;
        const auto rows = element_rows<D, T>(frame0, frame1, p0, t0, k0, p1, t1, k1, shape);
        for (const Sample& at : *rule) {
            const Bend<D, T> b = bend<D, T>(rows, at);
            const T factor = sqrt(scaled(b.speed, at.weight));
            for (const T& r : bending ? b.kappa : b.kappa_ds) *out++ = r * factor;
        }
        return true;
    }
};

struct CeresReport {
    double value, gradient;
    int iterations;
};

template <int D>
CeresReport levenberg_marquardt(Model<D>& model, const reference_options& options) {
    static std::once_flag quiet;
    std::call_once(quiet, [] { FLAGS_minloglevel = google::GLOG_FATAL; });

    ceres::Problem problem;
    for (auto& b : model.points) problem.AddParameterBlock(b.x.data(), D);
    for (auto& b : model.tangents) problem.AddParameterBlock(b.x.data(), D - 1);
    for (auto& b : model.curvatures) problem.AddParameterBlock(b.x.data(), D - 1);
    for (auto& e : model.elements) {
        problem.AddParameterBlock(e.shape, 4);
        auto* functor = new Residuals<D>{model.tangents[e.tangent[0]].frame, model.tangents[e.tangent[1]].frame, &model.rule,
                                         model.functional == Functional::mec};
        using Cost = ceres::AutoDiffCostFunction<Residuals<D>, ceres::DYNAMIC, D, D - 1, D - 1, D, D - 1, D - 1, 4>;
        problem.AddResidualBlock(new Cost(functor, int(model.rule.size()) * kBinormal<D>), nullptr,
                                 model.points[e.point[0]].x.data(), model.tangents[e.tangent[0]].x.data(),
                                 model.curvatures[e.curvature[0]].x.data(), model.points[e.point[1]].x.data(),
                                 model.tangents[e.tangent[1]].x.data(), model.curvatures[e.curvature[1]].x.data(), e.shape);
    }
    const auto hold = [&](auto& blocks) {
        for (auto& b : blocks)
            if (b.fixed) problem.SetParameterBlockConstant(b.x.data());
    };
    hold(model.points);
    hold(model.tangents);
    hold(model.curvatures);

    ceres::Solver::Options o;
    o.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
    // QR does not square the condition; beyond a few elements it costs too much.
    o.linear_solver_type = model.parameter_count() <= 60 ? ceres::DENSE_QR : ceres::SPARSE_NORMAL_CHOLESKY;
    o.max_num_iterations = options.ceres_iterations;
    o.function_tolerance = options.function_tolerance;
    o.gradient_tolerance = options.gradient_tolerance;
    o.parameter_tolerance = options.parameter_tolerance;
    o.max_num_consecutive_invalid_steps = 50;
    o.num_threads = 1;
    o.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(o, &problem, &summary);
    if (summary.termination_type == ceres::FAILURE) throw std::runtime_error("Ceres: " + summary.message.substr(0, 120));
    model.recentre();
    return {2 * summary.final_cost, summary.iterations.empty() ? 0 : summary.iterations.back().gradient_max_norm,
            int(summary.iterations.size()) - 1};
}

std::vector<Rows<3, double>> read_rows(const double* rows, size_t count) {
    std::vector<Rows<3, double>> elements(count);
    for (auto& element : elements)
        for (auto& row : element)
            for (double& c : row) {
                c = *rows++;
                if (!std::isfinite(c)) throw std::invalid_argument("the rows are not finite");
            }
    return elements;
}

template <int D>
void write_rows(const Model<D>& model, double* out) {
    for (size_t e = 0; e < model.elements.size(); ++e)
        for (const auto& row : model.rows(e))
            for (int c = 0; c < 3; ++c) *out++ = c < D ? row[c < D ? c : 0] : 0.0;
}

template <int D>
double curvature_at(const Rows<D, double>& rows, long double t) {
    const auto b = bend<D, double>(rows, sample_at(t, 0));
    if constexpr (D == 2) return b.kappa[0];
    else return std::sqrt(dot<3, double>(b.kappa, b.kappa));
}

// The largest sign * kappa: 200 samples, then golden sections about the best. A narrower peak may be missed.
template <int D>
double extreme_curvature(const Rows<D, double>& rows, double sign) {
    constexpr int kSamples = 200;
    const auto f = [&](double t) { return sign * curvature_at<D>(rows, t); };
    int best = 0;
    double top = f(0);
    for (int i = 1; i <= kSamples; ++i)
        if (const double k = f(double(i) / kSamples); k > top) top = k, best = i;
    double a = std::max(0, best - 1) / double(kSamples), b = std::min(kSamples, best + 1) / double(kSamples);
    const double ratio = (std::sqrt(5.0) - 1) / 2;
    for (int i = 0; i < 40; ++i) {
        const double c = b - ratio * (b - a), d = a + ratio * (b - a);
        const double fc = f(c), fd = f(d);
        top = std::max({top, fc, fd});
        if (fc > fd) b = d;
        else a = c;
    }
    return sign * top;
}

template <int D>
reference_measure measure(const std::vector<Rows<3, double>>& elements, int points) {
    const auto rule = samples(points);
    long double v = 0, e = 0, l = 0;
    reference_measure m{0, 0, 0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const auto& rows : elements) {
        Rows<D, long double> precise;
        Rows<D, double> plain;
        for (int r = 0; r < 6; ++r)
            for (int c = 0; c < D; ++c) precise[r][c] = plain[r][c] = rows[r][c];
        const auto sums = integrate<D, long double>(precise, rule, true, true);
        v += sums.V;
        e += sums.E;
        l += sums.L;
        m.kappa_min = std::min(m.kappa_min, extreme_curvature<D>(plain, -1));
        m.kappa_max = std::max(m.kappa_max, extreme_curvature<D>(plain, 1));
    }
    m.V = double(v);
    m.E = double(e);
    m.L = double(l);
    return m;
}

double functional_of(const reference_measure& m, int functional) {
    return functional == REFERENCE_MVC ? m.V : functional == REFERENCE_MEC ? m.E : m.L * m.L * m.L * m.V;
}

template <int D>
void solve(const reference_problem& problem, const reference_options& options, const std::vector<Rows<3, double>>& start,
           double* rows, reference_result& result) {
    Model<D> model(problem, start);
    result.start_value = result.ceres_value = model.value();
    // The length couples all elements of the scale-invariant form: no sum of squares for Ceres.
    if (options.ceres_iterations > 0 && model.parameter_count() > 0 && problem.functional != REFERENCE_SI_MVC) {
        const CeresReport report = levenberg_marquardt(model, options);
        result.ceres_value = report.value;
        result.ceres_gradient = report.gradient;
        result.ceres_iterations = report.iterations;
    }
    result.newton_iterations = newton(model, options.newton_iterations);
    result.certificate = certify(model);
    std::vector<double> out(18 * model.elements.size());
    write_rows(model, out.data());
    const auto elements = read_rows(out.data(), model.elements.size());
    result.measure = measure<D>(elements, problem.points);
    result.value = functional_of(result.measure, problem.functional);
    result.finer_value = functional_of(measure<D>(elements, 2 * problem.points + 1), problem.functional);
    const reference_certificate& c = result.certificate;
    // Also where the speed stays moderate and alpha grows.
    result.runaway = model.runaway() || !(result.measure.L < 100 * model.unit_length * double(model.elements.size()));
    // A value of rounding size (a circle's) has no relative accuracy: compare with that of a unit bend.
    const double unit = problem.functional == REFERENCE_MVC   ? 1 / std::pow(result.measure.L, 3)
                        : problem.functional == REFERENCE_MEC ? 1 / result.measure.L
                                                              : 1;
    result.converged = !result.runaway && c.decrement <= 1e-12 * result.value + 1e-18 * unit &&
                       c.smallest_eigenvalue >= -1e-12 * c.largest_eigenvalue;
    std::copy(out.begin(), out.end(), rows);
}

template <class F>
int32_t guarded(char* message, F work) {
    try {
        work();
        return 0;
    } catch (const std::exception& e) {
        std::strncpy(message, e.what(), REFERENCE_MESSAGE - 1);
        message[REFERENCE_MESSAGE - 1] = 0;
        return 1;
    }
}

}  // namespace
}  // namespace reference

using namespace reference;

extern "C" {

size_t reference_element_count(const reference_problem* problem) {
    return problem->joint_count < 2 ? 0 : span_count(*problem) * size_t(problem->elements_per_span);
}

int32_t reference_start(const reference_problem* problem, double* rows, char* message) {
    return guarded(message, [&] {
        check(*problem);
        for (const auto& element : start_rows(*problem))
            for (const auto& row : element)
                for (double c : row) *rows++ = c;
    });
}

int32_t reference_solve(const reference_problem* problem, const reference_options* options, const double* start,
                        double* rows, reference_result* result, char* message) {
    return guarded(message, [&] {
        check(*problem);
        const auto elements = start ? read_rows(start, reference_element_count(problem)) : start_rows(*problem);
        reference_result r{};
        if (problem->planar) solve<2>(*problem, *options, elements, rows, r);
        else solve<3>(*problem, *options, elements, rows, r);
        *result = r;
    });
}

int32_t reference_evaluate(const double* rows, size_t element_count, int32_t planar, int32_t points, reference_measure* out,
                           char* message) {
    return guarded(message, [&] {
        if (element_count < 1 || points < 1) throw std::invalid_argument("nothing to measure: no elements or no points");
        const auto elements = read_rows(rows, element_count);
        *out = planar ? measure<2>(elements, points) : measure<3>(elements, points);
    });
}

int32_t reference_certify(const reference_problem* problem, const double* rows, reference_certificate* certificate,
                          char* message) {
    return guarded(message, [&] {
        check(*problem);
        const size_t count = reference_element_count(problem);
        const auto elements = read_rows(rows, count);
        const auto run = [&](const auto& model) {
            reference_certificate c = certify(model);
            std::vector<double> back(18 * count);
            write_rows(model, back.data());
            for (size_t i = 0; i < back.size(); ++i) c.defect = std::max(c.defect, std::fabs(back[i] - rows[i]));
            *certificate = c;
        };
        if (problem->planar) run(Model<2>(*problem, elements));
        else run(Model<3>(*problem, elements));
    });
}

int32_t reference_gradient(const reference_problem* problem, const double* rows, const double* offset, double* value,
                           double* gradient, size_t* parameter_count, char* message) {
    return guarded(message, [&] {
        check(*problem);
        const auto elements = read_rows(rows, reference_element_count(problem));
        const auto run = [&](auto model) {
            const size_t n = model.parameter_count();
            if (offset) model.set(model.get() + Eigen::Map<const Eigen::VectorXd>(offset, n));
            if (gradient) {
                Eigen::VectorXd g;
                *value = model.gradient(g);
                std::copy(g.data(), g.data() + n, gradient);
            } else {
                *value = model.value();
            }
            *parameter_count = n;
        };
        if (problem->planar) run(Model<2>(*problem, elements));
        else run(Model<3>(*problem, elements));
    });
}

}  // extern "C"

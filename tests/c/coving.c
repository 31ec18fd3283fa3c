/* A curve and nothing else: the coving with one element and with eight. */
#include "check.h"

#include <stdlib.h>

static void solve(uint32_t elements_per_span, double variation) {
    minvar_joint joints[2];
    coving(joints);
    const minvar_curve curve = minvar_curve_through(joints, 2, 0);
    minvar_options options = minvar_options_defaults();
    options.elements_per_span = elements_per_span;

    size_t workspace_len = 0;
    WORKS(minvar_curve_workspace_len(&curve, &options, &workspace_len, e));
    const size_t count = minvar_curve_elements_len(&curve, &options);
    CHECK(count == elements_per_span);
    double *workspace = malloc(workspace_len * sizeof *workspace);
    minvar_element *elements = malloc(count * sizeof *elements);
    minvar_report report;
    WORKS(minvar_curve_solve(&curve, &options, workspace, workspace_len, NULL, NULL, elements, count, NULL, 0, &report,
                             e));
    CHECK(report.status == MINVAR_CONVERGED);
    CHECK(report.planar == 1);
    NEAR(report.variation, variation, 1e-8);
    NEAR(report.length, 23.939306, 1e-4);
    CHECK(elements[0].rows[0][0] == 0.5 && elements[0].rows[0][1] == -12.0);
    CHECK(elements[count - 1].rows[5][0] == 20.0 && elements[count - 1].rows[5][1] == -0.5);
    printf("%u elements: V %.10f, L %.6f, %zu doubles, %zu iterations\n", (unsigned)count, report.variation,
           report.length, workspace_len, report.iterations);
    free(elements);
    free(workspace);
}

int main(void) {
    CHECK(minvar_abi_check(MINVAR_ABI) == 1);
    CHECK(minvar_abi_check(MINVAR_ABI + 1) == 0);
    CHECK(strcmp(minvar_version(), MINVAR_VERSION_EXPECTED) == 0);
    solve(1, 0.0083518606);
    solve(8, 0.0083516963);
    return verdict();
}

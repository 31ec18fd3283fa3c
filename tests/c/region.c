/* A region of a curve edited as a C program would: in place, from its data, and past the end of a closed curve. */
#include "check.h"

enum { ROOM = 5000, POINTS = 6, REGION = 3 };

static double workspace[ROOM];
static minvar_options options;

static void solve(const minvar_joint *joints, size_t count, int closed, minvar_element *elements, size_t room) {
    const minvar_curve curve = minvar_curve_through(joints, count, closed);
    minvar_report report;
    WORKS(minvar_curve_solve(&curve, &options, workspace, ROOM, NULL, NULL, elements, room, NULL, 0, &report, e));
    CHECK(report.status == MINVAR_CONVERGED);
}

/* Position to the last bit, tangent and curvature to rounding. */
static void joins(const minvar_element *before, const minvar_element *after) {
    minvar_point end, start;
    WORKS(minvar_point_at(before, 1, 0, 1, &end, e));
    WORKS(minvar_point_at(after, 1, 0, 0, &start, e));
    CHECK(memcmp(before->rows[5], after->rows[0], sizeof before->rows[5]) == 0);
    for (int d = 0; d < 3; d++) {
        CHECK(fabs(end.tangent[d] - start.tangent[d]) < 1e-14);
        CHECK(fabs(end.curvature[d] - start.curvature[d]) < 1e-12);
    }
}

int main(void) {
    static const double points[POINTS][2] = {{3, 0}, {1.5, 1.8}, {-1, 2}, {-2.5, 0.5}, {-2, -1.5}, {0.5, -2.2}};
    minvar_joint joints[POINTS];
    minvar_element before[POINTS], elements[POINTS], fresh[REGION];
    minvar_report report;
    options = minvar_options_defaults();
    for (int i = 0; i < POINTS; i++) {
        joints[i] = minvar_joint_at(points[i][0], points[i][1], 0);
    }
    solve(joints, POINTS, 1, before, POINTS);
    memcpy(elements, before, sizeof before);

    /* Joint 3 is dragged: elements 2 and 3 change where they are. */
    minvar_joint inner[4] = {joints[2], joints[3], joints[4]};
    WORKS(minvar_region_hold(elements, POINTS, 1, 2, 2, inner, 3, e));
    const minvar_curve region = minvar_curve_through(inner, 3, 0);
    for (int step = 1; step <= 5; step++) {
        inner[1].position.value[0] -= 0.02;
        WORKS(minvar_curve_update(&region, &options, workspace, ROOM, NULL, NULL, elements + 2, 2, &report, e));
        CHECK(report.status == MINVAR_CONVERGED);
    }
    CHECK(elements[2].rows[5][0] == inner[1].position.value[0] && inner[1].position.value[0] < -2.59);
    for (int i = 0; i < POINTS; i++) {
        CHECK((memcmp(&elements[i], &before[i], sizeof before[i]) == 0) == (i != 2 && i != 3));
        joins(&elements[i], &elements[(i + 1) % POINTS]);
    }

    /* From joint 5 over the first to joint 2, with the first moved: elements 5, 0 and 1. */
    inner[0] = joints[5];
    inner[1] = minvar_joint_at(3.1, 0.1, 0);
    inner[2] = joints[1];
    inner[3] = joints[2];
    WORKS(minvar_region_hold(elements, POINTS, 1, 5, REGION, inner, 4, e));
    solve(inner, 4, 0, fresh, REGION);
    for (int i = 0; i < REGION; i++) {
        elements[(5 + i) % POINTS] = fresh[i];
    }
    CHECK(elements[0].rows[0][0] == 3.1);
    for (int i = 0; i < POINTS; i++) {
        joins(&elements[i], &elements[(i + 1) % POINTS]);
    }
    return verdict();
}

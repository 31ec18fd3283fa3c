/* The list of the corpus, and how its lines are named. */
#include "corpus.h"
#include "platform/decimal.h"

static corpus_listener listen;
static char name[96];
static size_t name_length;

static void append(const char *text) {
    while (*text != '\0' && name_length + 1 < sizeof name) {
        name[name_length++] = *text++;
    }
    name[name_length] = '\0';
}

void begin(const char *first, const char *second, const char *third) {
    const char *const parts[3] = {first, second, third};
    name_length = 0;
    for (int i = 0; i < 3 && parts[i] != NULL; i++) {
        if (i > 0) {
            append("/");
        }
        append(parts[i]);
    }
}

void begin_number(const char *first, const char *second, unsigned number) {
    char room[24];
    begin(first, second, decimal(number, room));
}

void end(const char *part, const digest *sum, const char *outcome) {
    const size_t kept = name_length;
    append("/");
    append(part);
    listen(name, sum->state, outcome);
    name_length = kept;
    name[name_length] = '\0';
}

const char *code_word(minvar_code code) {
    static char word[] = "error-00";
    if (code == MINVAR_OK) {
        return "ok";
    }
    word[6] = (char)('0' + (unsigned)code / 10 % 10);
    word[7] = (char)('0' + (unsigned)code % 10);
    return word;
}

const char *status_word(minvar_status status) {
    static const char *const words[] = {"unsolved", "converged", "stalled", "iteration-limit", "unbounded", "cancelled"};
    return (unsigned)status < sizeof words / sizeof *words ? words[status] : "unknown";
}

void add_error(digest *sum, minvar_code code, const minvar_error *error) {
    add_whole(sum, (uint64_t)code);
    add_whole(sum, (uint64_t)error->code);
    add_whole(sum, error->index);
    add_whole(sum, error->needed);
    add_whole(sum, error->given);
    add_text(sum, error->message);
}

void add_report(digest *sum, const minvar_report *of) {
    add_whole(sum, (uint64_t)of->status);
    add_whole(sum, (uint64_t)of->planar);
    add_whole(sum, of->elements);
    add_whole(sum, of->iterations);
    add_whole(sum, of->linearisations);
    add_whole(sum, of->unknowns);
    const double figures[] = {of->value, of->fine_value, of->length,   of->variation,
                              of->bending, of->error,    of->gradient, of->decrement};
    add_doubles(sum, figures, sizeof figures / sizeof *figures);
}

void add_elements(digest *sum, const minvar_element *of, size_t count) {
    for (size_t i = 0; i < count; i++) {
        for (int row = 0; row < 6; row++) {
            add_doubles(sum, of[i].rows[row], 3);
        }
    }
}

void add_point(digest *sum, const minvar_point *of) {
    add_whole(sum, of->element);
    add_double(sum, of->parameter);
    add_double(sum, of->arc_length);
    add_doubles(sum, of->point, 3);
    add_doubles(sum, of->tangent, 3);
    add_doubles(sum, of->curvature, 3);
    add_double(sum, of->signed_curvature);
    add_double(sum, of->curvature_derivative);
    add_double(sum, of->torsion);
}

void corpus(corpus_listener listener, int with_long) {
    listen = listener;
    begin("library", NULL, NULL);
    digest sum = empty_digest();
    add_text(&sum, minvar_version());
    for (uint32_t status = 0; status < 7; status++) {
        add_text(&sum, minvar_status_sentence(status));
    }
    end("words", &sum, minvar_abi_check(MINVAR_ABI) ? "ok" : "another-interface");

    appendix_a();
    random_curves();
    endings();
    refusals();
    if (with_long) {
        more_of_appendix_a();
        more_random_curves();
    }
}

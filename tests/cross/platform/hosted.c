/* A machine with a C library. */
#include <stdio.h>

#include "platform.h"

void platform_print(const char *text) { fputs(text, stdout); }

/* The compiled core of Rust names this, which nothing calls in a library that cannot unwind. Where the linker does not drop
 * what names it, as from a build without optimisation, somebody must have it. */
void rust_eh_personality(void);
void rust_eh_personality(void) {}

/* WebAssembly: text goes to a function of the host's. */
#include <stddef.h>

#include "platform.h"

__attribute__((import_module("host"), import_name("print"))) void host_print(const char *text, size_t length);

void platform_print(const char *text) {
    size_t length = 0;
    while (text[length] != '\0') {
        length++;
    }
    host_print(text, length);
}

int main(void);

__attribute__((export_name("run"))) int run(void);
int run(void) { return main(); }

/* What a program needs of the machine it runs on: platform/, a file, one a kind. */
#ifndef PLATFORM_H
#define PLATFORM_H

/* Text without its NUL. */
void platform_print(const char *text);

#endif

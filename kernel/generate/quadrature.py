#!/usr/bin/env python3
"""Writes kernel/src/basis/quadrature/tables.rs: Gauss-Lobatto and Gauss-Legendre rules on [0, 1].

    python3 kernel/generate/quadrature.py > kernel/src/basis/quadrature/tables.rs

Needs mpmath. Nodes and weights are computed with 60 digits and rounded once, so every constant is the f64 nearest to
the true value; a node near 1 is rounded from 1 - x itself, not from the rounded x.
"""

from mpmath import cos, mp, mpf, pi

mp.dps = 60
LARGEST = 32
WIDTH = 110


def legendre_and_derivatives(n, z):
    """P_n, P_n' and P_n'' at z inside (-1, 1), by the three-term recurrence and Legendre's equation."""
    before, here = mpf(0), mpf(1)
    for k in range(n):
        before, here = here, ((2 * k + 1) * z * here - k * before) / (k + 1)
    first = n * (before - z * here) / (1 - z * z)
    second = (2 * z * first - n * (n + 1) * here) / (1 - z * z)
    return here, first, second


def newton(z, value_and_slope):
    for _ in range(60):
        value, slope = value_and_slope(z)
        step = value / slope
        z -= step
        if abs(step) < mpf(10) ** (5 - mp.dps):
            return z
    raise ArithmeticError("no convergence")


def gauss_legendre(n):
    """The n (node, weight) pairs on [0, 1], ascending."""
    pairs = []
    for i in range(n):
        start = -cos(pi * (i + mpf(3) / 4) / (n + mpf(1) / 2))
        z = mpf(0) if 2 * i + 1 == n else newton(start, lambda z: legendre_and_derivatives(n, z)[:2])
        slope = legendre_and_derivatives(n, z)[1]
        pairs.append(((1 + z) / 2, 1 / ((1 - z * z) * slope**2)))
    return pairs


def gauss_lobatto(n):
    """The n (node, weight) pairs on [0, 1], ascending; the ends are nodes."""
    end = mpf(1) / (n * (n - 1))
    pairs = [(mpf(0), end)]
    for i in range(1, n - 1):
        start = -cos(pi * i / (n - 1))
        z = mpf(0) if 2 * i + 1 == n else newton(start, lambda z: legendre_and_derivatives(n - 1, z)[1:])
        pairs.append(((1 + z) / 2, end / legendre_and_derivatives(n - 1, z)[0] ** 2))
    return pairs + [(mpf(1), end)]


def check(n, pairs, degree):
    nodes = [x for x, _ in pairs]
    assert len(pairs) == n and all(a < b for a, b in zip(nodes, nodes[1:])), n
    for k in range(degree + 1):
        assert abs(sum(w * x**k for x, w in pairs) - mpf(1) / (k + 1)) < mpf(10) ** -50, (n, k)


def table(name, doc, rules, column):
    rows, count = [], 0
    for n, pairs in rules:
        rows.append(f"    // {n}")
        line = "   "
        for pair in pairs:
            text = f" {float(pair[column])!r},"
            if len(line) + len(text) > WIDTH:
                rows.append(line)
                line = "   "
            line += text
            count += 1
        rows.append(line)
    body = "\n".join(rows)
    return f"/// {doc}\n#[rustfmt::skip]\npub(super) static {name}: [f64; {count}] = [\n{body}\n];\n"


def main():
    lobatto = [(n, gauss_lobatto(n)) for n in range(2, LARGEST + 1)]
    gauss = [(n, gauss_legendre(n)) for n in range(1, LARGEST + 1)]
    for n, pairs in lobatto:
        check(n, pairs, 2 * n - 3)
    for n, pairs in gauss:
        check(n, pairs, 2 * n - 1)
    print("//! Written by `kernel/generate/quadrature.py`: change that, not this. Rules follow one another by count.\n")
    print(table("LOBATTO_NODES", "The nodes of the Gauss–Lobatto rules of 2, 3, … 32 points.", lobatto, 0))
    print(table("LOBATTO_WEIGHTS", "The weights of the Gauss–Lobatto rules of 2, 3, … 32 points.", lobatto, 1))
    print(table("LEGENDRE_NODES", "The nodes of the Gauss–Legendre rules of 1, 2, … 32 points.", gauss, 0))
    print(table("LEGENDRE_WEIGHTS", "The weights of the Gauss–Legendre rules of 1, 2, … 32 points.", gauss, 1), end="")


main()

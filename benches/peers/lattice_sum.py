"""The certified 50-digit sum of benches/sums.rs by direct summation with python-flint and mpmath, for comparison.

Sum of W over a square lattice at R = 32 spacings, Wendland C2 (W_0 = 7/pi): prints the value and the median of 15 runs.
"""
import statistics
import time

RADIUS, DIGITS, RUNS = 32, 50, 15


def shells():
    counts = {}
    for i in range(-RADIUS, RADIUS + 1):
        for j in range(-RADIUS, RADIUS + 1):
            n = i * i + j * j
            if n < RADIUS * RADIUS:
                counts[n] = counts.get(n, 0) + 1
    return sorted(counts.items())


def by_flint():
    from flint import arb, ctx

    ctx.dps = DIGITS + 10
    total = arb(0)
    for n, count in shells():
        q = arb(n).sqrt() / RADIUS
        total += count * (1 - q) ** 4 * (1 + 4 * q)
    return total * 7 / arb.pi() / RADIUS**2


def by_mpmath():
    from mpmath import mp, mpf, sqrt

    mp.dps = DIGITS + 10
    total = mpf(0)
    for n, count in shells():
        q = sqrt(mpf(n)) / RADIUS
        total += count * (1 - q) ** 4 * (1 + 4 * q)
    return total * 7 / mp.pi / RADIUS**2


for name, function in (("python-flint", by_flint), ("mpmath", by_mpmath)):
    seconds = []
    for _ in range(RUNS):
        start = time.perf_counter()
        value = function()
        seconds.append(time.perf_counter() - start)
    print(f"{name}: {statistics.median(seconds) * 1e3:.2f} ms  {str(value)[:60]}")

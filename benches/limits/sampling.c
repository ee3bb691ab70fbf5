/* What one core can do: random points of six models and four moments of their outputs, in C as fast as the compiler makes it.
 *
 *     cc -O3 -march=native -ffast-math -o sampling limits/sampling.c -lmvec -lm
 *     ./sampling engine 4194304
 *
 * Sixteen xoshiro256++ side by side (Blackman and Vigna 2021), a ziggurat of 1024 layers (Doornik 2005), elementary functions of the
 * system's vector library, blocks of 1024 points, sums of four powers about the first value. Prints CPU seconds and the moments, so
 * that a run that computes something else is seen. Results differ from processor to processor, which sensitol's may not.
 */
#define _GNU_SOURCE
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { LANES = 16, LAYERS = 1024, BLOCK = 1024, MOST = 1000 };

static uint64_t state[4][LANES], words[BLOCK];
static double width[LAYERS + 1], height[LAYERS + 1];
static double z[MOST][BLOCK];

static uint64_t mixed(uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static uint64_t turned(uint64_t x, int by) { return x << by | x >> (64 - by); }

static void fill(uint64_t *out, int count) {
    uint64_t *a = state[0], *b = state[1], *c = state[2], *d = state[3];
    for (int i = 0; i < count; i += LANES)
        for (int k = 0; k < LANES; k++) {
            uint64_t w = a[k], x = b[k], y = c[k], v = d[k];
            out[i + k] = turned(w + v, 23) + w;
            y ^= w, v ^= x;
            b[k] = x ^ y, a[k] = w ^ v, c[k] = y ^ x << 17, d[k] = turned(v, 45);
        }
}

static double symmetric(uint64_t word) {
    union { uint64_t bits; double value; } u = {word >> 12 | 0x4000000000000000u};
    return u.value - 3.0;
}

static double unit(void) {
    static uint64_t row[LANES];
    fill(row, LANES);
    return ((row[0] >> 12) + 0.5) / 4503599627370496.0;
}

static void layers(void) {
    const double tail = 4.0388498461095045;
    double beyond = sqrt(acos(-1.0) / 2) * erfc(tail / sqrt(2.0)), area = tail * exp(-0.5 * tail * tail) + beyond;
    width[0] = area / exp(-0.5 * tail * tail), width[1] = tail;
    for (int i = 2; i < LAYERS; i++)
        width[i] = sqrt(-2 * log(area / width[i - 1] + exp(-0.5 * width[i - 1] * width[i - 1])));
    for (int i = 0; i <= LAYERS; i++) height[i] = exp(-0.5 * width[i] * width[i]);
}

static double settled(uint64_t word) {
    for (;;) {
        int layer = word % LAYERS;
        double x = symmetric(word) * width[layer];
        if (fabs(x) < width[layer + 1]) return x;
        if (layer) {
            if (height[layer] + (height[layer + 1] - height[layer]) * unit() < exp(-0.5 * x * x)) return x;
        } else {
            for (;;) {
                double far = -log(unit()) / width[1];
                if (-2 * log(unit()) >= far * far) return copysign(width[1] + far, x);
            }
        }
        static uint64_t row[LANES];
        fill(row, LANES), word = row[0];
    }
}

static void normals(double *out) {
    static double inner[BLOCK];
    fill(words, BLOCK);
    for (int i = 0; i < BLOCK; i++) out[i] = width[words[i] % LAYERS], inner[i] = width[words[i] % LAYERS + 1];
    for (int i = 0; i < BLOCK; i++) out[i] *= symmetric(words[i]);
    for (int first = 0; first < BLOCK; first += 32) {
        int any = 0;
        for (int i = first; i < first + 32; i++) any |= fabs(out[i]) >= inner[i];
        if (any)
            for (int i = first; i < first + 32; i++)
                if (fabs(out[i]) >= inner[i]) out[i] = settled(words[i]);
    }
}

static void evens(double *out) {
    fill(words, BLOCK);
    for (int i = 0; i < BLOCK; i++) out[i] = symmetric(words[i]);
}

typedef struct { double centre, sums[4]; long n; } Moments;

static void add(Moments *m, const double *y) {
    double s1 = 0, s2 = 0, s3 = 0, s4 = 0;
    if (!m->n) m->centre = y[0];
    for (int i = 0; i < BLOCK; i++) {
        double d = y[i] - m->centre, q = d * d;
        s1 += d, s2 += q, s3 += q * d, s4 += q * q;
    }
    m->sums[0] += s1, m->sums[1] += s2, m->sums[2] += s3, m->sums[3] += s4, m->n += BLOCK;
}

static void show(const Moments *m) {
    double a = m->sums[0] / m->n, b = m->sums[1] / m->n;
    printf(" %.6g %.6g", m->centre + a, sqrt(b - a * a));
}

static double y[3][BLOCK];
static Moments out[3];

/* Two loops: of one argument's sine and cosine the compiler makes one call that takes no vectors. */
static void turn(const double *angle, double *sine, double *cosine) {
    for (int i = 0; i < BLOCK; i++) sine[i] = sin(angle[i]);
    for (int i = 0; i < BLOCK; i++) cosine[i] = cos(angle[i]);
}

static int engine(void) {
    const double angle = 0.00872 / 3, length = 0.00004 / 3, pi = acos(-1.0), phi[4] = {0, pi, 3 * pi, 2 * pi};
    for (int d = 0; d < 10; d++) normals(z[d]);
    memset(y, 0, sizeof y);
    for (int n = 0; n < 4; n++)
        for (int i = 0; i < BLOCK; i++) {
            double c = cos(angle * z[5][i] + phi[n] + angle * z[6 + n][i]);
            double ratio = (0.0425 + length * z[1][i]) / (0.1345 + length * z[2][i]), share = c + ratio * (2 * c * c - 1);
            y[0][i] += share, y[1][i] += n * share;
        }
    for (int i = 0; i < BLOCK; i++) {
        double hp = 0.0973 + length * z[3][i], hc = 0.0372 + length * z[4][i];
        double scale = (0.427 + 0.597 * hc / (hc + hp)) * (0.0425 + length * z[1][i]) * 628.3185 * 628.3185;
        y[0][i] *= scale, y[1][i] *= scale * (0.05 + 0.0001 / 3 * z[0][i]);
    }
    return 2;
}

static int clutch(void) {
    for (int d = 0; d < 3; d++) normals(z[d]);
    for (int i = 0; i < BLOCK; i++) {
        double hub = 55.29 + 0.05 / 3 * z[0][i], roller = 22.86 + 0.02 / 3 * z[1][i], cage = 101.69 + 0.05 / 3 * z[2][i];
        y[0][i] = acos((hub + roller) / (cage - roller));
    }
    return 1;
}

static int blocks(void) {
    const double deg = acos(-1.0) / 180;
    static double angle[BLOCK], sine[BLOCK], cosine[BLOCK];
    for (int d = 0; d < 8; d++) normals(z[d]);
    for (int i = 0; i < BLOCK; i++) angle[i] = (17 + z[7][i] / 3) * deg;
    turn(angle, sine, cosine);
    for (int i = 0; i < BLOCK; i++) {
        double a = 10 + 0.1 * z[0][i], b = 30 + 0.1 * z[1][i], c = 31.9 + 0.1 * z[2][i], e = 55 + 0.1 * z[3][i];
        double f = 75 + 0.5 / 3 * z[4][i], R = 40 + 0.1 * z[5][i], r = 10 + 0.1 / 3 * z[6][i];
        double tangent = sine[i] / cosine[i], q = (R * sine[i] + r) / (R - r);
        y[0][i] = f - r - (c + e / cosine[i] + (a - b) * tangent - R * sine[i] * tangent) + (R - r) * sqrt(1 - q * q);
    }
    return 1;
}

static int uniforms(void) {
    memset(y, 0, sizeof y);
    for (int d = 0; d < 1000; d++) {
        evens(z[0]);
        for (int i = 0; i < BLOCK; i++) y[0][i] += 1 + 0.1 * z[0][i];
    }
    return 1;
}

static int correlated(void) {
    static double factor[6][6];
    if (!factor[0][0])
        for (int j = 0; j < 6; j++)
            for (int k = 0; k <= j; k++) {
                double sum = j == k ? 1 : 0.5;
                for (int l = 0; l < k; l++) sum -= factor[j][l] * factor[k][l];
                factor[j][k] = j == k ? sqrt(sum) : sum / factor[k][k];
            }
    for (int d = 0; d < 6; d++) normals(z[d]);
    memset(y, 0, sizeof y);
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < BLOCK; i++) {
            double x = 0;
            for (int k = 0; k <= j; k++) x += factor[j][k] * z[k][i];
            y[0][i] += (j % 2 ? -1 : 1) * (10 + 0.1 / 3 * x);
        }
    return 1;
}

static int gun(void) {
    const double deg = acos(-1.0) / 180;
    static double angle[BLOCK], sine[5][BLOCK], cosine[5][BLOCK];
    for (int d = 0; d < 22; d++) normals(z[d]);
    memset(y, 0, sizeof y);
    for (int arm = 0; arm < 2; arm++) {
        double s = arm ? -1 : 1, (*x)[BLOCK] = z + 11 * arm;
        /* Bend, skew, closing, tilt, yaw: the input of each, its middle and its sigma. */
        const int input[5] = {7, 8, 5, 3, 4};
        const double middle[5] = {30 * s, 0, -30 * s, 0, 0}, sigma[5] = {1. / 6, 0.2, 1. / 6, 1. / 6, 0.2};
        for (int k = 0; k < 5; k++) {
            for (int i = 0; i < BLOCK; i++) angle[i] = (middle[k] + sigma[k] * x[input[k]][i]) * deg;
            turn(angle, sine[k], cosine[k]);
        }
        for (int i = 0; i < BLOCK; i++) {
            double front = 150 + 2 * x[9][i] / 3, tip = 70 + x[10][i] / 6, rear = 120 + 2 * x[6][i] / 3, hang = -s * tip;
            double ahead = front * cosine[0][i] + hang * sine[0][i], up = hang * cosine[0][i] - front * sine[0][i];
            double Y = ahead * sine[1][i], X = rear + ahead * cosine[1][i], Z, t;
            t = X * cosine[2][i] + up * sine[2][i], Z = up * cosine[2][i] - X * sine[2][i], X = t;
            t = Y * cosine[3][i] - Z * sine[3][i], Z = Y * sine[3][i] + Z * cosine[3][i], Y = t;
            t = X * cosine[4][i] - Y * sine[4][i], Y = X * sine[4][i] + Y * cosine[4][i], X = t;
            y[0][i] += s * (15 * s + x[2][i] / 6 + Z), y[1][i] += s * (x[0][i] + X), y[2][i] += s * (x[1][i] / 6 + Y);
        }
    }
    return 3;
}

int main(int count, char **text) {
    static const struct { const char *name; int (*block)(void); } cases[] = {
        {"engine", engine}, {"clutch", clutch}, {"blocks", blocks},
        {"uniforms", uniforms}, {"correlated", correlated}, {"gun", gun},
    };
    long samples = count > 2 ? atol(text[2]) : 0;
    layers();
    for (int i = 0; i < 4 * LANES; i++) state[i / LANES][i % LANES] = mixed(mixed(7) + i);
    for (unsigned c = 0; c < sizeof cases / sizeof *cases; c++)
        if (count > 2 && !strcmp(text[1], cases[c].name)) {
            int outputs = 0;
            clock_t begun = clock();
            for (long done = 0; done < samples; done += BLOCK) {
                outputs = cases[c].block();
                for (int k = 0; k < outputs; k++) add(&out[k], y[k]);
            }
            printf("%.6f", (double)(clock() - begun) / CLOCKS_PER_SEC);
            for (int k = 0; k < outputs; k++) show(&out[k]);
            puts("");
            return 0;
        }
    fprintf(stderr, "usage: sampling engine|clutch|blocks|uniforms|correlated|gun SAMPLES\n");
    return 2;
}

/* A child in C: `flips MODE SEED [MILLISECONDS]`, with that time for each answer. Models with a memory, and some without; z are the dimensions in tenths off the nominal ones.

   The right answer is y(z) = sum a_i z_i + sum b_i z_i^2 + c z_1 z_2, and 9 - y(z) is that of the mirrored assembly.
   toggle   every move of more than 1.4 leads to the other assembly, where it stays until the next such move
   pairs    the same, but only where more than one dimension is off
   drift    something is added with every point
   random   3 % of the answers are of the mirrored assembly
   stray    3 % of the answers are wrong, no two of them by the same amount
   edge     9 more just above the nominal value of the first dimension; no memory
   jump     2 more where z_1 is above 0.5; no memory
   smooth   strongly curved; no memory
   plain    the right answer; no memory

   slopes   the right answer with its derivatives, declared as gradients; no memory
   silence  the same, without those that it declares
   wrong    the same, with the derivative by the second dimension 20 % too large

   And what a program may say beside its answers:
   cluster  isolated, with places, heartbeats and starts, and a window that grows; dies once, at the file named by SEED
   queue    lets the first point wait for 3 s, with heartbeats, before it starts
   silent   starts a point, says that it is alive and never ends
   hangs    takes back points, and never ends the one with the first dimension above 12
   takes    takes back points, all of which it answers all the same */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MOST 64
static char line[1 << 20];
static double nominal[MOST], last[MOST], a[MOST], b[MOST], c;
static int n;
static unsigned long long state;

/* xorshift64*: the same numbers everywhere. */
static double uniform(void) {
    state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
    return (double)((state * 2685821657736338717ULL) >> 11) / 9007199254740992.0;
}

static int numbers(const char *text, const char *key, double *out) {
    const char *at = strstr(text, key);
    int count = 0;
    if (!at) return 0;
    at = strchr(at, '[') + 1;
    while (*at != ']') {
        char *end;
        out[count++] = strtod(at, &end);
        at = *end == ',' ? end + 1 : end;
    }
    return count;
}

static double right(const double *z) {
    double y = c * z[0] * z[1];
    for (int i = 0; i < n; i++) y += a[i] * z[i] + b[i] * z[i] * z[i];
    return y;
}

static void rest(int milliseconds) { usleep(1000 * milliseconds); }

int main(int count, char **argument) {
    const char *mode = argument[1];
    int flipped = 0, answered = 0, dies = 0;
    if (count < 3) return 2;
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (!fgets(line, sizeof line, stdin)) return 0;
    n = numbers(line, "\"nominal\"", nominal);
    memcpy(last, nominal, sizeof last);
    state = 88172645463325252ULL + 1000003ULL * strtoull(argument[2], NULL, 10);
    for (int i = 0; i < 20; i++) uniform();
    for (int i = 0; i < n; i++) a[i] = 0.5 + uniform(), b[i] = 0.1 * uniform();
    c = 0.2 * uniform();
    if (!strcmp(mode, "cluster")) {
        dies = access(argument[2], F_OK) != 0;
        puts("{\"ready\":true,\"isolated\":true,\"heartbeat\":true,\"places\":2,\"window\":4}");
        puts("{\"window\":8}");
    } else if (!strcmp(mode, "queue") || !strcmp(mode, "silent"))
        puts("{\"ready\":true,\"heartbeat\":true,\"window\":8}");
    else if (!strcmp(mode, "takes") || !strcmp(mode, "hangs"))
        puts("{\"ready\":true,\"heartbeat\":true,\"cancel\":true,\"window\":8}");
    else if (!strcmp(mode, "slopes") || !strcmp(mode, "silence") || !strcmp(mode, "wrong"))
        puts("{\"ready\":true,\"name\":\"slopes\",\"version\":1,\"window\":4,\"gradients\":true}");
    else
        puts("{\"ready\":true,\"name\":\"flips\",\"version\":1,\"window\":4}");
    while (fgets(line, sizeof line, stdin)) {
        double x[MOST] = {0}, z[MOST] = {0}, way = 0, y;
        int id, off = 0;
        if (strstr(line, "\"cancel\"")) {
            fprintf(stderr, "taken back\n");
            continue;
        }
        id = atoi(strstr(line, "\"id\":") + 5);
        numbers(line, "\"x\"", x);
        for (int i = 0; i < n; i++) {
            z[i] = (x[i] - nominal[i]) / 0.1;
            way = fmax(way, fabs(x[i] - last[i]) / 0.1);
            off += x[i] != nominal[i];
            last[i] = x[i];
        }
        if (count > 3) rest(atoi(argument[3]));
        y = right(z);
        if ((!strcmp(mode, "toggle") && way > 1.4) || (!strcmp(mode, "pairs") && way > 1.4 && off > 1)) flipped = !flipped;
        if (!strcmp(mode, "random")) {
            /* By the number of the point, so that a fresh child does not repeat the errors of the one before. */
            state = 88172645463325252ULL + 1000003ULL * strtoull(argument[2], NULL, 10) + 7919ULL * (unsigned long long)id;
            for (int i = 0; i < 20; i++) uniform();
            flipped = uniform() < 0.03;
        }
        if (flipped) y = 9 - y;
        if (!strcmp(mode, "stray")) {
            /* By the child and the point, so that no two wrong answers agree. */
            state = 88172645463325252ULL + 1000003ULL * (unsigned long long)getpid() + 7919ULL * (unsigned long long)id;
            for (int i = 0; i < 20; i++) uniform();
            if (uniform() < 0.03) y += 1 + 8 * uniform();
        }
        if (!strcmp(mode, "drift")) y += 0.01 * answered;
        if (!strcmp(mode, "jump")) y += z[0] > 0.5 ? 2 : 0;
        if (!strcmp(mode, "edge")) y += z[0] > 0.02 ? 9 : 0;
        if (!strcmp(mode, "smooth")) y = exp(0.8 * y / n) * (1 + z[1] * z[1]) + a[0] * cos(2 * z[0]);
        answered++;
        if (!strcmp(mode, "cluster")) {
            const char *place = strstr(line, "\"place\":\"east\"") ? "east" : strstr(line, "\"place\":\"west\"") ? "west" : id % 2 ? "east" : "west";
            if (dies && answered == 6) {
                fclose(fopen(argument[2], "w"));
                return 9;
            }
            printf("{\"id\":%d,\"started\":\"%s\"}\n{\"alive\":true,\"running\":1,\"queued\":7,\"note\":\"at %s\"}\n", id, place, place);
            printf("{\"id\":%d,\"y\":[%.17g],\"where\":\"%s\",\"cost_s\":0.25}\n", id, y, place);
            continue;
        }
        if (!strcmp(mode, "queue")) {
            /* The first one waits for longer than a point may take. */
            for (int i = 0; answered == 1 && i < 60; i++) rest(50), puts("{\"alive\":true,\"running\":0,\"queued\":8}");
            printf("{\"id\":%d,\"started\":\"here\"}\n", id);
        }
        if (!strcmp(mode, "slopes") || !strcmp(mode, "wrong")) {
            printf("{\"id\":%d,\"y\":[%.17g],\"dy\":[[", id, y);
            for (int i = 0; i < n; i++) {
                double slope = a[i] + 2 * b[i] * z[i] + (i < 2 ? c * z[1 - i] : 0);
                printf("%s%.17g", i ? "," : "", slope / 0.1 * (i == 1 && *mode == 'w' ? 1.2 : 1));
            }
            puts("]]}");
            continue;
        }
        if (!strcmp(mode, "takes")) rest(20);
        if (!strcmp(mode, "silent")) {
            for (int i = 0; i < 200; i++) {
                rest(30);
                if (i == 0) printf("{\"id\":%d,\"started\":\"here\"}\n", id);
                puts("{\"alive\":true,\"running\":1,\"queued\":0}");
            }
        }
        if (!strcmp(mode, "hangs") ) {
            printf("{\"id\":%d,\"started\":\"here\"}\n", id);
            if (x[0] > 12) continue;
        }
        printf("{\"id\":%d,\"y\":[%.17g]}\n", id, y);
    }
    return 0;
}

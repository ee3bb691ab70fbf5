/* A mass on a spring with a damper, m x'' + c x' + k x = 0, let go at x0: an FMU of FMI 2 or 3, for model exchange and co-simulation.
   Built by make.py with -DFMI=2 or -DFMI=3. Variables: 0 time, 1 m, 2 c, 3 k, 4 x0, 5 x, 6 v, 7 der(x), 8 der(v). */

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

#define OUT __attribute__((visibility("default")))
enum { OK = 0, ERROR = 3 };
enum { TIME, M, C, K, X0, X, V, DX, DV, COUNT };
/* Steps of the Runge-Kutta method within a communication step. */
enum { SUBSTEPS = 20 };

typedef struct {
    double value[COUNT];
} Model;

static const double START[COUNT] = {0, 2.0, 1.5, 800.0, 10.0, 10.0, 0, 0, 0};

static void slopes(const Model *model, const double state[2], double result[2]) {
    const double *v = model->value;
    result[0] = state[1];
    result[1] = -(v[C] * state[1] + v[K] * state[0]) / v[M];
}

static int start(Model *model) {
    model->value[X] = model->value[X0];
    model->value[V] = 0;
    return model->value[M] > 0 ? OK : ERROR;
}

static void reset(Model *model) {
    for (int i = 0; i < COUNT; i++) model->value[i] = START[i];
}

static int get(Model *model, const unsigned *references, size_t count, double *values) {
    slopes(model, &model->value[X], &model->value[DX]);
    for (size_t i = 0; i < count; i++) {
        if (references[i] >= COUNT) return ERROR;
        values[i] = model->value[references[i]];
    }
    return OK;
}

static int set(Model *model, const unsigned *references, size_t count, const double *values) {
    for (size_t i = 0; i < count; i++) {
        if (references[i] < M || references[i] > X0) return ERROR;
        model->value[references[i]] = values[i];
    }
    return OK;
}

static void step(Model *model, double length) {
    double h = length / SUBSTEPS, *state = &model->value[X];
    for (int i = 0; i < SUBSTEPS; i++) {
        double a[2], b[2], c[2], d[2], at[2];
        slopes(model, state, a);
        for (int j = 0; j < 2; j++) at[j] = state[j] + h / 2 * a[j];
        slopes(model, at, b);
        for (int j = 0; j < 2; j++) at[j] = state[j] + h / 2 * b[j];
        slopes(model, at, c);
        for (int j = 0; j < 2; j++) at[j] = state[j] + h * c[j];
        slopes(model, at, d);
        for (int j = 0; j < 2; j++) state[j] += h / 6 * (a[j] + 2 * b[j] + 2 * c[j] + d[j]);
    }
    model->value[TIME] += length;
}

static void *made(void) {
    Model *model = calloc(1, sizeof(Model));
    if (model) reset(model);
    return model;
}

#if FMI == 2
#define NAME(name) fmi2##name
#else
#define NAME(name) fmi3##name
#endif

/* The standard wants every function to be there; a simulation calls none of these. */
#define ABSENT(name) OUT int NAME(name)(void) { return ERROR; }

/* The same in both versions. */
OUT void NAME(FreeInstance)(void *model) { free(model); }
OUT int NAME(ExitInitializationMode)(void *model) { return start(model); }
OUT int NAME(EnterEventMode)(void *model) { (void)model; return OK; }
OUT int NAME(EnterContinuousTimeMode)(void *model) { (void)model; return OK; }
OUT int NAME(Terminate)(void *model) { (void)model; return OK; }
OUT int NAME(Reset)(void *model) { reset(model); return OK; }
OUT int NAME(SetTime)(Model *model, double time) { model->value[TIME] = time; return OK; }
OUT int NAME(GetEventIndicators)(void *model, double *values, size_t count) { (void)model; (void)values; (void)count; return OK; }
OUT int NAME(SetContinuousStates)(Model *model, const double *states, size_t count) {
    for (size_t i = 0; i < count; i++) model->value[X + i] = states[i];
    return OK;
}
OUT int NAME(GetContinuousStates)(Model *model, double *states, size_t count) {
    for (size_t i = 0; i < count; i++) states[i] = model->value[X + i];
    return OK;
}
OUT int NAME(GetNominalsOfContinuousStates)(void *model, double *values, size_t count) {
    (void)model;
    for (size_t i = 0; i < count; i++) values[i] = 1;
    return OK;
}

#if FMI == 2
typedef struct {
    int needed, terminate, nominals, values, defined;
    double next;
} EventInfo;

OUT const char *fmi2GetTypesPlatform(void) { return "default"; }
OUT const char *fmi2GetVersion(void) { return "2.0"; }
OUT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *place, const void *functions, int visible, int logging) {
    (void)name; (void)type; (void)guid; (void)place; (void)functions; (void)visible; (void)logging;
    return made();
}
OUT int fmi2SetupExperiment(Model *model, int has, double tolerance, double begin, int ends, double stop) {
    (void)has; (void)tolerance; (void)ends; (void)stop;
    model->value[TIME] = begin;
    return OK;
}
OUT int fmi2EnterInitializationMode(void *model) { (void)model; return OK; }
OUT int fmi2GetReal(Model *model, const unsigned *references, size_t count, double *values) { return get(model, references, count, values); }
OUT int fmi2SetReal(Model *model, const unsigned *references, size_t count, const double *values) { return set(model, references, count, values); }
OUT int fmi2NewDiscreteStates(void *model, EventInfo *info) { (void)model; *info = (EventInfo){0}; return OK; }
OUT int fmi2CompletedIntegratorStep(void *model, int no, int *event, int *terminate) { (void)model; (void)no; *event = *terminate = 0; return OK; }
OUT int fmi2GetDerivatives(Model *model, double *values, size_t count) { (void)count; slopes(model, &model->value[X], values); return OK; }
OUT int fmi2DoStep(Model *model, double time, double length, int no) { (void)time; (void)no; step(model, length); return OK; }
ABSENT(CancelStep) ABSENT(DeSerializeFMUstate) ABSENT(FreeFMUstate) ABSENT(GetBoolean) ABSENT(GetBooleanStatus)
ABSENT(GetDirectionalDerivative) ABSENT(GetFMUstate) ABSENT(GetInteger) ABSENT(GetIntegerStatus)
ABSENT(GetRealOutputDerivatives) ABSENT(GetRealStatus) ABSENT(GetStatus) ABSENT(GetString) ABSENT(GetStringStatus)
ABSENT(SerializeFMUstate) ABSENT(SerializedFMUstateSize) ABSENT(SetBoolean) ABSENT(SetDebugLogging) ABSENT(SetFMUstate)
ABSENT(SetInteger) ABSENT(SetRealInputDerivatives) ABSENT(SetString)
#else
OUT const char *fmi3GetVersion(void) { return "3.0"; }
OUT void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *place, bool visible, bool logging, void *environment, void *log) {
    (void)name; (void)token; (void)place; (void)visible; (void)logging; (void)environment; (void)log;
    return made();
}
OUT void *fmi3InstantiateCoSimulation(
    const char *name, const char *token, const char *place, bool visible, bool logging, bool events, bool early,
    const unsigned *required, size_t count, void *environment, void *log, void *update) {
    (void)name; (void)token; (void)place; (void)visible; (void)logging; (void)events; (void)early;
    (void)required; (void)count; (void)environment; (void)log; (void)update;
    return made();
}
OUT int fmi3EnterInitializationMode(Model *model, bool has, double tolerance, double begin, bool ends, double stop) {
    (void)has; (void)tolerance; (void)ends; (void)stop;
    model->value[TIME] = begin;
    return OK;
}
OUT int fmi3GetFloat64(Model *model, const unsigned *references, size_t count, double *values, size_t length) { (void)length; return get(model, references, count, values); }
OUT int fmi3SetFloat64(Model *model, const unsigned *references, size_t count, const double *values, size_t length) { (void)length; return set(model, references, count, values); }
OUT int fmi3UpdateDiscreteStates(void *model, bool *needed, bool *terminate, bool *nominals, bool *values, bool *defined, double *next) {
    (void)model;
    *needed = *terminate = *nominals = *values = *defined = false;
    *next = 0;
    return OK;
}
OUT int fmi3CompletedIntegratorStep(void *model, bool no, bool *event, bool *terminate) { (void)model; (void)no; *event = *terminate = false; return OK; }
OUT int fmi3GetContinuousStateDerivatives(Model *model, double *values, size_t count) { (void)count; slopes(model, &model->value[X], values); return OK; }
OUT int fmi3DoStep(Model *model, double time, double length, bool no, bool *event, bool *terminate, bool *early, double *last) {
    (void)no;
    *event = *terminate = *early = false;
    step(model, length);
    *last = time + length;
    return OK;
}
ABSENT(ActivateModelPartition) ABSENT(DeserializeFMUState) ABSENT(EnterConfigurationMode) ABSENT(EnterStepMode)
ABSENT(EvaluateDiscreteStates) ABSENT(ExitConfigurationMode) ABSENT(FreeFMUState) ABSENT(GetAdjointDerivative)
ABSENT(GetBinary) ABSENT(GetBoolean) ABSENT(GetClock) ABSENT(GetDirectionalDerivative) ABSENT(GetFMUState)
ABSENT(GetFloat32) ABSENT(GetInt16) ABSENT(GetInt32) ABSENT(GetInt64) ABSENT(GetInt8) ABSENT(GetIntervalDecimal)
ABSENT(GetIntervalFraction) ABSENT(GetNumberOfContinuousStates) ABSENT(GetNumberOfEventIndicators)
ABSENT(GetNumberOfVariableDependencies) ABSENT(GetOutputDerivatives) ABSENT(GetShiftDecimal) ABSENT(GetShiftFraction)
ABSENT(GetString) ABSENT(GetUInt16) ABSENT(GetUInt32) ABSENT(GetUInt64) ABSENT(GetUInt8)
ABSENT(GetVariableDependencies) ABSENT(InstantiateScheduledExecution) ABSENT(SerializeFMUState)
ABSENT(SerializedFMUStateSize) ABSENT(SetBinary) ABSENT(SetBoolean) ABSENT(SetClock) ABSENT(SetDebugLogging)
ABSENT(SetFMUState) ABSENT(SetFloat32) ABSENT(SetInt16) ABSENT(SetInt32) ABSENT(SetInt64) ABSENT(SetInt8)
ABSENT(SetIntervalDecimal) ABSENT(SetIntervalFraction) ABSENT(SetShiftDecimal) ABSENT(SetShiftFraction)
ABSENT(SetString) ABSENT(SetUInt16) ABSENT(SetUInt32) ABSENT(SetUInt64) ABSENT(SetUInt8)
#endif

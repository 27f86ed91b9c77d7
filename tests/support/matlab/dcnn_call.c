/* SPDX-License-Identifier: Apache-2.0 */
/* outputs = dcnn_call(LIBRARY, FUNCTION, arguments…): the functions that examples/predict.m calls, by their names in the
 * library; the result and every argument as it is after the call. Handles are uint64. */
#include <dcnn.h>
#include <dlfcn.h>
#include <mex.h>
#include <stdint.h>
#include <string.h>

static dcnn_tool* handle_of(const mxArray* a) { return (dcnn_tool*)(uintptr_t)*(uint64_t*)mxGetData(a); }
static double* numbers_of(mxArray* a) { return mxIsEmpty(a) ? NULL : mxGetPr(a); }
static char* text_of(const mxArray* a) { return mxIsEmpty(a) ? NULL : mxArrayToString(a); }

static mxArray* handle(const void* p) {
  mxArray* a = mxCreateNumericMatrix(1, 1, mxUINT64_CLASS, mxREAL);
  *(uint64_t*)mxGetData(a) = (uint64_t)(uintptr_t)p;
  return a;
}

void mexFunction(int outputs, mxArray* out[], int inputs, const mxArray* in[]) {
  void* library = dlopen(mxArrayToString(in[0]), RTLD_NOW);
  const char* name = mxArrayToString(in[1]);
  void* function = library ? dlsym(library, name) : NULL;
  int k;
  if (!function) mexErrMsgTxt("dcnn_call: no such function");
  for (k = 1; k < outputs && k + 1 < inputs; ++k) out[k] = mxDuplicateArray(in[k + 1]);
  if (strcmp(name, "dcnn_open") == 0) {
    char* message = text_of(in[5]);
    out[0] = handle(((dcnn_tool * (*)(const char*, const char*, const char*, char*, size_t)) function)(
        text_of(in[2]), text_of(in[3]), text_of(in[4]), message, (size_t)mxGetScalar(in[6])));
    out[4] = mxCreateString(message);
  } else if (strcmp(name, "dcnn_close") == 0) {
    ((void (*)(dcnn_tool*))function)(handle_of(in[2]));
    out[0] = mxCreateDoubleMatrix(0, 0, mxREAL);
  } else if (strcmp(name, "dcnn_step") == 0) {
    int (*step)(dcnn_tool*, double, const double*, const double*, const double*, double*, double*);
    step = (int (*)(dcnn_tool*, double, const double*, const double*, const double*, double*, double*))function;
    out[0] = mxCreateDoubleScalar(step(handle_of(in[2]), mxGetScalar(in[3]), numbers_of(out[3]), numbers_of(out[4]),
                                       numbers_of(out[5]), numbers_of(out[6]), numbers_of(out[7])));
  } else {
    mexErrMsgTxt("dcnn_call: examples/predict.m does not call this");
  }
}

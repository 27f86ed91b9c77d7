/* SPDX-License-Identifier: Apache-2.0
 *
 * The force that a robot's tool puts on its wrist sensor, sample by sample, from C and from any language that
 * calls C (library libdcnn.so.0).
 *
 *   char error[256];
 *   dcnn_tool* tool = dcnn_open("model.dcnn", "sim.json", NULL, error, sizeof error);
 *   for (each control cycle) state = dcnn_step(tool, t, position, quaternion, wrench, own, external);
 *   dcnn_close(tool);
 *
 * Units: s, m, N, N*m. Frames: B robot base, E the frame whose pose the robot reports, S the sensor. A wrench is
 * (fx, fy, fz, tx, ty, tz), torque about the origin of S.
 * Threads: calls for one handle one after the other, from any thread; different handles at the same time.
 * Handles: one that was closed must not be used again, nor closed a second time. NULL is no handle, and no function
 * fails for it: dcnn_step() and dcnn_miss() return -1, questions 0 or "none".
 * Texts: what dcnn_version(), dcnn_state_name() and dcnn_reason() return is constant and stays valid as long as the
 * library is loaded, also after dcnn_close(); it is not to be freed.
 * Real time: dcnn_step() and the questions below it allocate, lock and throw nothing and make no system call.
 * ABI: libdcnn.so.0 keeps every function and constant of this header as it is; additions are new functions.
 */
#ifndef DCNN_H
#define DCNN_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dcnn_tool dcnn_tool;

/* Where the external force of a cycle comes from, in order of trust. */
enum {
  DCNN_WARMUP = 0,  /* windows fill: external stays zero */
  DCNN_NETWORK = 1, /* the trained model */
  DCNN_PHYSICS = 2, /* the simulator: the only model, or the fallback while the network cannot be trusted */
  DCNN_HOLD = 3,    /* neither: the last output */
  DCNN_FADE = 4,    /* and not soon enough again: to zero */
  DCNN_FAULT = 5    /* latched until dcnn_rearm() */
};

/* "0.1.0". */
const char* dcnn_version(void);

/* Opens `model`: a file of `dcnn-train --online` (.dcnn), or a simulator (.json) such as the model.json of
 * dcnn-diagnose. `fallback`: a simulator that steps in for a trained model, or NULL. `calibration`: the mounting
 * of the sensor from dcnn-calibrate, or NULL for that of the model. NULL on failure, with one line of text in
 * `error` (at most `error_size` bytes with the end; `error` may be NULL). On success `error` stays as it was: look at
 * the handle, not at the text. The files are read here, whole: they may be replaced or removed afterwards. */
dcnn_tool* dcnn_open(const char* model, const char* fallback, const char* calibration, char* error,
                     size_t error_size);

/* Ends the handle, which nothing may use after it. NULL is nothing to close. */
void dcnn_close(dcnn_tool* handle);

/* One sample. `t` [s] on the robot's clock, `position[3]` of the origin of E in B [m], `quaternion[4]` (w, x, y, z)
 * of E in B, `wrench[6]` as measured, in S, or NULL where only the tool's own is wanted.
 * Writes to `own[6]` what the tool itself puts on the sensor, in S, and to `external[6]` what acts from outside, in
 * B: finite, bounded, slew-limited. Either may be NULL. Torques are zero where the model has none.
 * Returns one of the states above; -1 for a NULL handle or pose. Numbers may be anything: a sample that is not
 * finite is a bad cycle, not an error. */
int dcnn_step(dcnn_tool* handle, double t, const double* position, const double* quaternion, const double* wrench,
              double* own, double* external);

/* A cycle in which no sample came. Writes and returns as dcnn_step(). */
int dcnn_miss(dcnn_tool* handle, double* external);

/* The operator's word that a fault is over; counts with the next sample. */
void dcnn_rearm(dcnn_tool* handle);

double dcnn_sample_time(const dcnn_tool* handle); /* s, that samples must have */
int dcnn_has_torque(const dcnn_tool* handle);     /* 1 where torques are predicted */
int dcnn_contact(const dcnn_tool* handle);        /* 1 while the external force is above the contact threshold */
double dcnn_novelty(const dcnn_tool* handle);     /* above 1: motion unlike training; 0 where that is not known */
const char* dcnn_state_name(int state);      /* "NETWORK" */
const char* dcnn_reason(const dcnn_tool* handle); /* why the network is not followed, "none" where it is */

#ifdef __cplusplus
}
#endif
#endif

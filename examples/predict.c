/* SPDX-License-Identifier: Apache-2.0 */
/* The external force from C: reads "t x y z qw qx qy qz fx fy fz" lines, writes "t state fx fy fz".
 *   cc predict.c -ldcnn && ./a.out sim.json < samples.txt */
#include <dcnn.h>
#include <stdio.h>

int main(int argc, char** argv) {
  char error[256];
  double t, p[3], q[4], w[6] = {0}, own[6], external[6];
  dcnn_tool* tool;
  if (argc < 2) {
    puts("usage: predict MODEL [FALLBACK] < samples");
    return 2;
  }
  tool = dcnn_open(argv[1], argc > 2 ? argv[2] : NULL, NULL, error, sizeof error);
  if (!tool) {
    fprintf(stderr, "predict: %s\n", error);
    return 1;
  }
  while (scanf("%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &t, p, p + 1, p + 2, q, q + 1, q + 2, q + 3, w, w + 1,
               w + 2) == 11) {
    const int state = dcnn_step(tool, t, p, q, w, own, external);
    printf("%.9g %s %.9g %.9g %.9g\n", t, dcnn_state_name(state), external[0], external[1], external[2]);
  }
  dcnn_close(tool);
  return 0;
}

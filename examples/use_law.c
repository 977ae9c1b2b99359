/* A body of 8.9 kg hits a wire at mid-span, in C: the wire is the law that `snare distil` has exported. The same as use_law.cpp.

     snare distil data/wires/traced_published.toml --out my_law --set 'exports.name="wire"'
     gcc -I my_law examples/use_law.c my_law/law.c -lm -o use_law && ./use_law */
#include "law.h"

#include <stdio.h>

#ifndef SLACK
#define SLACK 0.597e-3 /* of this wire: its length less the span [m] */
#endif

int main(void) {
  const double mass = 8.9, speed = 0.05, step = 1e-5; /* kg, m/s, s */
  const double middle = 87.5e-3, slack = SLACK;
  double travel = 0.0, velocity = speed, deepest = 0.0;
  while (travel >= 0.0) { /* the leapfrog method; beyond the wire there is no force */
    velocity -= 0.5 * step * wire_force(travel, middle, slack) / mass;
    travel += step * velocity;
    velocity -= 0.5 * step * wire_force(travel, middle, slack) / mass;
    if (travel > deepest) deepest = travel;
  }
  printf("deepest travel: %.6g mm\n", 1e3 * deepest);
  printf("speed of return over that of approach: %.6g\n", -velocity / speed);
  return wire_in_range(deepest, middle, slack) ? 0 : 1;
}

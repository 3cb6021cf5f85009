#include "mjcf.h"

#include <stdio.h>

bool mjcf_write(const struct scene *scene, const char *path)
{
    FILE *const file = fopen(path, "w");
    if (!file) {
        return false;
    }
    fputs("<mujoco><option timestep=\"0.002\" cone=\"elliptic\" impratio=\"10\"><flag energy=\"enable\"/></option>\n"
          "<default><geom friction=\"0.8\" density=\"1000\"/></default>\n"
          "<worldbody><geom type=\"box\" size=\"5 5 0.5\" pos=\"0 0 -0.5\"/></worldbody>\n", file);
    for (int i = 0; i < scene->count; i++) {
        const struct scene_body *const body = &scene->bodies[i];
        fprintf(file, "<asset><mesh name=\"m%d\" vertex=\"", i);
        for (int k = 0; k < body->count; k++) {
            fprintf(file, "%.9g %.9g %.9g ", (double)body->points[k][0], (double)body->points[k][1], (double)body->points[k][2]);
        }
        fprintf(file, "\"/></asset>\n<worldbody><body pos=\"%.17g %.17g %.17g\" quat=\"%.17g %.17g %.17g %.17g\">", body->place[0],
                body->place[1], body->place[2], body->quaternion[0], body->quaternion[1], body->quaternion[2], body->quaternion[3]);
        fprintf(file, "%s<geom type=\"mesh\" mesh=\"m%d\"/></body></worldbody>\n", body->fixed ? "" : "<freejoint/>", i);
    }
    fputs("</mujoco>\n", file);
    const bool written = !ferror(file);
    return fclose(file) == 0 && written;
}

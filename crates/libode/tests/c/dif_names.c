/* An exported world tells its name, its bodies and joints. */
#include "check.h"

int main(void) {
    dInitODE2(0);
    dWorldID w = dWorldCreate();
    dBodyID a, b;
    two_bodies(w, &a, &b);
    dJointID j = dJointCreateHinge(w, 0);
    dJointAttach(j, a, b);
    FILE *file = tmpfile();
    dWorldExportDIF(w, file, "crane_");
    static char text[50000];
    rewind(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    CHECKI(dWorldExportDIF, strstr(text, "crane_world") != 0);
    showi("bodies", strstr(text, "crane_body[0]") != 0 && strstr(text, "crane_body[1]") != 0);
    showi("joint", strstr(text, "hinge") != 0);
    dWorldDestroy(w);
    dCloseODE();
    return 0;
}

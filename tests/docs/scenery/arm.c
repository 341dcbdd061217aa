/* An application with two branches, of which one is taken. */
#include <stdint.h>

int32_t CFE_ES_RunLoop(uint32_t *run);
int32_t OS_TaskDelay(uint32_t ms);

void ARM_Main(void)
{
    uint32_t run = 1;
    for (int step = 0; CFE_ES_RunLoop(&run); step++)
        OS_TaskDelay(step < 1000 ? 100 : 200);
}

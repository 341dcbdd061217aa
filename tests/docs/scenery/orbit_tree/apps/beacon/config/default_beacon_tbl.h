#include "cfe.h"

typedef struct
{
    uint32 PeriodMs;
} BEACON_Table_t;

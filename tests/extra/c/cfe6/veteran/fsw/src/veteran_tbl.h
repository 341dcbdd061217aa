#ifndef VETERAN_TBL_H
#define VETERAN_TBL_H
#include "cfe.h"

typedef struct {
    CFE_SB_MsgId_t MsgId; /* 16 bits */
    uint16 Limit;
} VETERAN_Row_t;
#endif

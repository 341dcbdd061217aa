/* What the applications of these tests have in common: they write what calls answer into the system log. */
#include "cfe.h"
#include "cfe_config.h"
#include "cfe_resourceid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SAY(...) CFE_ES_WriteToSysLog("> " __VA_ARGS__)
/* The call as it stands here, and its status. */
#define TELL(call) tell(#call, (uint32)(call))

static inline void tell(const char *call, uint32 status) { SAY("%.90s: %08X", call, (unsigned)status); }

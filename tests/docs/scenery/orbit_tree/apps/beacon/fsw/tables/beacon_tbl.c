#include "cfe_tbl_filedef.h"
#include "beacon_tbl.h"

BEACON_Table_t Beacon = {500};

CFE_TBL_FILEDEF(Beacon, BEACON.Settings, Period of the beacon, beacon_tbl.tbl)

#include "cfe_tbl_filedef.h"
#include "veteran_msgids.h"
#include "veteran_tbl.h"

VETERAN_Row_t VETERAN_Rows[2] = {{VETERAN_HK_TLM_MID, 7}, {CFE_SB_HIGHEST_VALID_MSGID, 9}};
CFE_TBL_FILEDEF(VETERAN_Rows, VETERAN.Rows, Rows of the test, veteran_rows.tbl)

/* A configuration of CF whose first channel waits for a semaphore of another application. */
#include "cfe.h"
#include "cfe_tbl_filedef.h"
#include "cf_tbldefs.h"

CF_ConfigTable_t CF_config_table = {
    .ticks_per_second             = 10,
    .rx_crc_calc_bytes_per_wakeup = 1024,
    .local_eid                    = 25,
    .chan[0] = {.mid_input = 0x18c8, .mid_output = 0x08c2, .pipe_depth_input = 16, .sem_name = "DOWNLINK_SEM"},
    .chan[1] = {.mid_input = 0x18c9, .mid_output = 0x08c3, .pipe_depth_input = 16},
    .outgoing_file_chunk_size     = 200,
    .tmp_dir                      = "/cf/tmp",
};
CFE_TBL_FILEDEF(CF_config_table, CF.config_table, CF config table, cf_def_config.tbl)

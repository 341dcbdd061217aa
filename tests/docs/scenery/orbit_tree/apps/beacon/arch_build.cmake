generate_configfile_set(beacon_tbl.h)

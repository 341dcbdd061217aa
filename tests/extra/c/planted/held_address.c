/* The address of a table is not given back when there is nothing to do, so the next load waits for it. */
void BUG_Main(void)
{
    static uint32_t image[4] = {0, 0, 0, 0};
    uint32_t run = RUN;
    int16_t rows;
    CFE_EVS_Register(NULL, 0, 0);
    CFE_TBL_Register(&rows, "Rows", sizeof image, 0, NULL);
    CFE_TBL_Load(rows, 1, image);
    CFE_TBL_Load(rows, 1, image); /* from the second load on, cFE protects a table that is in use */
    for (int i = 0; CFE_ES_RunLoop(&run); i++) {
        uint32_t *found = NULL;
        CFE_TBL_Manage(rows);
        CFE_TBL_GetAddress((void **)&found, rows);
#ifdef MENDED
        CFE_TBL_ReleaseAddress(rows);
#else
        if (found[0] != 0)
            CFE_TBL_ReleaseAddress(rows);
#endif
        if (i == 5) {
            image[0] = 1;
            CFE_TBL_Load(rows, 1, image);
        }
        OS_TaskDelay(100);
    }
    CFE_ES_ExitApp(run);
}

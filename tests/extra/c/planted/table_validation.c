/* A validation function trusts a count that is in the table. */
enum { ROWS = 8 };
struct list { uint32_t count, rows[ROWS]; };
static int16_t table;

static int32_t validate(void *image)
{
    const struct list *list = image;
#ifdef MENDED
    if (list->count > ROWS)
        return -1;
#endif
    for (uint32_t i = 0; i < list->count; i++)
        if (list->rows[i] > 100)
            return -1;
    return 0;
}

void BUG_Main(void)
{
    struct list list = {0};
    uint32_t run = RUN;
    CFE_TBL_Register(&table, "List", sizeof list, 0, validate);
    CFE_TBL_Load(table, 1, &list);
    CFE_ES_RunLoop(&run);
    list.count = 10;
    SAY("loaded: %d", CFE_TBL_Load(table, 1, &list) == 0);
    CFE_ES_ExitApp(EXIT);
}

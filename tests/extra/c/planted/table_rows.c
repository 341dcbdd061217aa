/* A loop over the rows of a table takes one row too many. */
enum { ROWS = 5 };
struct row { uint32_t limit, period; };
static int16_t table;

void BUG_Main(void)
{
    static const struct row rows[ROWS] = {{1, 10}, {2, 20}, {3, 30}, {4, 40}, {5, 50}};
    struct row *row;
    uint32_t longest = 0, run = RUN;
    CFE_TBL_Register(&table, "Rows", sizeof rows, 0, NULL);
    CFE_TBL_Load(table, 1, rows);
    CFE_ES_RunLoop(&run);
    CFE_TBL_GetAddress((void **)&row, table);
#ifdef MENDED
    for (int i = 0; i < ROWS; i++)
#else
    for (int i = 0; i <= ROWS; i++)
#endif
        if (row[i].period > longest)
            longest = row[i].period;
    SAY("%u", (unsigned)longest);
    CFE_TBL_ReleaseAddress(table);
    CFE_ES_ExitApp(EXIT);
}

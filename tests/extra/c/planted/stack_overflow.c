/* A buffer on the stack that is larger than the stack. */
static int sum(void)
{
#ifdef MENDED
    static volatile char buffer[20000];
#else
    volatile char buffer[20000];
#endif
    int total = 0;
    for (int i = 0; i < 20000; i++)
        buffer[i] = (char)i;
    for (int i = 0; i < 20000; i++)
        total += buffer[i];
    return total;
}

void BUG_Main(void)
{
    uint32_t run = RUN;
    CFE_ES_RunLoop(&run);
    SAY("%d", sum());
    CFE_ES_ExitApp(EXIT);
}

/* A time in ms that is kept in 16 bits: after a minute a wait never ends. */
void BUG_Main(void)
{
    uint32_t run = RUN;
#ifdef MENDED
    uint32_t now = 0, next = 0;
#else
    uint16_t now = 0;
    uint32_t next = 0;
#endif
    static uint8_t message[16];
    CFE_MSG_Init(message, 0x0899, sizeof message);
    while (CFE_ES_RunLoop(&run)) {
        now += 100;
        if (now >= next) {
            CFE_SB_TransmitMsg(message, true);
            next += 1000;
        }
        OS_TaskDelay(100);
    }
    CFE_ES_ExitApp(run);
}

/* A message buffer is neither sent nor given back when there is nothing to tell. */
void BUG_Main(void)
{
    uint32_t run = RUN;
    CFE_EVS_Register(NULL, 0, 0);
    for (int i = 0; CFE_ES_RunLoop(&run); i++) {
        uint8_t *message = CFE_SB_AllocateMessageBuffer(1000);
        if (message == NULL) {
            CFE_EVS_SendEvent(1, 3, "no buffer after %d turns", i);
            break;
        }
        CFE_MSG_Init(message, 0x0899, 1000);
        if (i % 5 == 0)
            CFE_SB_TransmitBuffer(message, true);
#ifdef MENDED
        else
            CFE_SB_ReleaseMessageBuffer(message);
#endif
        OS_TaskDelay(10);
    }
    CFE_ES_ExitApp(run);
}

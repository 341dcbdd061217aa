/* A name is copied with its NUL into a block that has no room for it. */
void BUG_Main(void)
{
    static const char name[] = "a name of thirty-two characters.";
    uint32_t run = RUN;
    CFE_ES_RunLoop(&run);
#ifdef MENDED
    char *copy = malloc(strlen(name) + 1);
#else
    char *copy = malloc(strlen(name));
#endif
    strcpy(copy, name);
    SAY("%s", copy);
    free(copy);
    CFE_ES_ExitApp(EXIT);
}

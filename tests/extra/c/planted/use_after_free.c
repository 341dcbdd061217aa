/* A list is freed while it is walked. */
struct node { int value; struct node *next; };

void BUG_Main(void)
{
    struct node *list = NULL;
    uint32_t run = RUN;
    CFE_ES_RunLoop(&run);
    for (int i = 0; i < 3; i++) {
        struct node *made = malloc(sizeof *made);
        made->value = i;
        made->next = list;
        list = made;
    }
    while (list != NULL) {
#ifdef MENDED
        struct node *next = list->next;
        free(list);
        list = next;
#else
        free(list);
        list = list->next;
#endif
    }
    CFE_ES_ExitApp(EXIT);
}

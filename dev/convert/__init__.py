"""Programs about the convertor: public nodes, damaged sources, flights on NASA's cFE."""

"""The graph of a mission: senders, messages, and the pipes of receivers, and its presentation.

What belongs here knows what a flight has shown (`model`) and presents it: as text, for graphviz, as a drawing. The
flight itself, and the number of lost messages, belong to the report of a run.
"""

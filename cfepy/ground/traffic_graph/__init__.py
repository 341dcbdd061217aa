"""The graph of a mission: who sends which messages into whose pipes, and how that is drawn.

What belongs here knows what a flight has shown (`model`) and writes it down for people and for other programs: as text,
for graphviz, as a drawing. What the flight was like, and how many messages were lost, belongs to the report of a run.
"""

"""swaystride: reproducible studies of human movement with wearable inertial sensors.

Rooms stand on floors, and a module imports only from floors below its own
(``docs/architecture.md``; a test enforces it):

====  =============================  ==============================================
6     ``report``                     pages and comparison with the printed numbers
5     ``studies``, ``validation``    plans, tables and figures of one study
4     ``simulate``                   bodies, sensors and cohorts with known truth
3     ``sway gait erkf mocap``       from signals to quantities of balance, strides, joint angles
2     ``signals stats presentation`` filters; statistics; number and figure style
1     ``io``                         one reader (and writer) per vendor format
0     top-level modules              recording, rotations, units, errors, findings
====  =============================  ==============================================
"""

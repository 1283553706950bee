"""What `sinuous bench ik` compares with: common solvers, written and compiled as ours is.

All of them end with the last tube parallel to the base's y axis. By (10) that fixes the joint A_N
for a target, so that it is enough to bring A_N there with the joints before it and to straighten
the last one. The two least-squares methods also come as they are mostly written, with the whole
task as rows: the tip's position and the direction of the last tube, for all joints.
"""

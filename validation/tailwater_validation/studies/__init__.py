"""Every study of `tailwater validate`, one function of a Plan each."""

from . import (comparisons, exact, flume, janosi2004, kleefsman2005, liquids, liu1999, martin_moyce1952, openings, operators, ozmen_cagatay2014, shallow,
               soares_frazao2002, thick, zhou1999)

LABORATORIES = (zhou1999, martin_moyce1952, janosi2004, ozmen_cagatay2014, soares_frazao2002, kleefsman2005, liu1999)

FUNCTIONS = (*(laboratory.study for laboratory in LABORATORIES), operators.operators, operators.poisson, exact.tank,
             exact.taylor_green, exact.standing_wave, exact.drop, exact.poiseuille, exact.couette, exact.uniform_flow,
             exact.jet, exact.slot, exact.water_wedge, exact.wedge_entry, thick.thick_film, thick.viscous_dam_break,
             thick.yielding_slump, liquids.layered_tank, liquids.internal_wave, liquids.rayleigh_taylor,
             liquids.lock_exchange, shallow.ritter, shallow.stoker, shallow.rough_dry_bed,
             shallow.rough_wet_bed, flume.weir, flume.broad_weir, flume.ogee, flume.sluice_gate, flume.hydraulic_jump,
             flume.channel, flume.backwater, flume.circulation, flume.solitary_wave, flume.run_up, flume.wave_flume, flume.irregular_waves,
             flume.floating_box, openings.openings, comparisons.integrators, comparisons.wet_bed, comparisons.schemes, comparisons.devices,
             comparisons.slip, comparisons.time_step, comparisons.sill_time_step, comparisons.starts)


def studies(plan):
    """{name: Study}, in the order of the report."""
    return {study.name: study for study in (function(plan) for function in FUNCTIONS)}

//! A layout of the viewer as it is built: views, the containers around them, and what is set of each. The library's own needs streams,
//! has random names, and no way to set most properties.

use rerun::external::re_sdk_types::blueprint::archetypes::{
    ContainerBlueprint, PanelBlueprint, TimePanelBlueprint, ViewBlueprint, ViewContents,
    ViewportBlueprint,
};
use rerun::external::re_sdk_types::blueprint::components::{ContainerKind, PanelState};
use rerun::external::re_sdk_types::{View, datatypes};
use rerun::{AsComponents, EntityPath, RecordingStreamResult, TimeColumn};

use super::recorder::Recorder;

/// The timeline of the store that a layout is in: what a user changes comes later on it.
const TIMELINE: &str = "blueprint";

/// A view or a container.
#[derive(Debug)]
pub struct Pane {
    /// Where it is in the store of the layout.
    path: String,
    id: [u8; 16],
}

/// The panes made so far.
#[derive(Debug)]
pub struct Layout {
    rec: Recorder,
    panes: u64,
}

impl Layout {
    pub fn new() -> Self {
        Self {
            rec: Recorder::of_section(0),
            panes: 0,
        }
    }

    /// A view of a class, its name, and the entity that it begins with.
    pub fn view<V: View>(&mut self, name: &str, origin: &str) -> RecordingStreamResult<Pane> {
        let pane = self.pane("view");
        let contents = ViewContents::new(["$origin/**"]);
        self.log(&format!("{}/ViewContents", pane.path), &contents)?;
        let view = ViewBlueprint::new(V::identifier().as_str())
            .with_display_name(name)
            .with_space_origin(format!("/{origin}"));
        self.log(&pane.path, &view)?;
        Ok(pane)
    }

    /// Sets a property of a view.
    pub fn set(
        &mut self,
        pane: &Pane,
        property: &str,
        value: &dyn AsComponents,
    ) -> RecordingStreamResult<()> {
        self.log(&format!("{}/{property}", pane.path), value)
    }

    /// Sets what a view does with an entity and all below it.
    pub fn set_of(
        &mut self,
        pane: &Pane,
        entity: &EntityPath,
        value: &dyn AsComponents,
    ) -> RecordingStreamResult<()> {
        let entity = entity.to_string();
        let entity = entity.trim_start_matches('/');
        let property = format!("ViewContents/overrides/{entity}/visualizers");
        self.set(pane, &property, value)
    }

    /// Panes beside one another, each with its share of the width.
    pub fn beside(
        &mut self,
        panes: &[Pane],
        shares: impl IntoIterator<Item = f32>,
    ) -> RecordingStreamResult<Pane> {
        let kind = ContainerBlueprint::new(ContainerKind::Horizontal);
        self.container(panes, kind.with_col_shares(shares))
    }

    /// Panes one below another, each with its share of the height.
    pub fn below(
        &mut self,
        panes: &[Pane],
        shares: impl IntoIterator<Item = f32>,
    ) -> RecordingStreamResult<Pane> {
        let kind = ContainerBlueprint::new(ContainerKind::Vertical);
        self.container(panes, kind.with_row_shares(shares))
    }

    /// Panes in rows of so many.
    pub fn grid(&mut self, panes: &[Pane], columns: u32) -> RecordingStreamResult<Pane> {
        let kind = ContainerBlueprint::new(ContainerKind::Grid);
        self.container(panes, kind.with_grid_columns(columns))
    }

    /// The whole: a pane that fills the window, and the panel of time; the others are hidden.
    pub fn finished(
        mut self,
        root: &Pane,
        time: &TimePanelBlueprint,
    ) -> RecordingStreamResult<Recorder> {
        let viewport = ViewportBlueprint::new()
            .with_root_container(datatypes::Uuid::from(root.id))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.log("viewport", &viewport)?;
        let hidden = PanelBlueprint::new().with_state(PanelState::Hidden);
        self.log("blueprint_panel", &hidden)?;
        self.log("selection_panel", &hidden)?;
        self.log("time_panel", time)?;
        Ok(self.rec)
    }

    fn container(
        &mut self,
        panes: &[Pane],
        container: ContainerBlueprint,
    ) -> RecordingStreamResult<Pane> {
        let pane = self.pane("container");
        let contents = panes.iter().map(|p| format!("/{}", p.path));
        self.log(&pane.path, &container.with_contents(contents))?;
        Ok(pane)
    }

    /// Named by its number, in the form of a UUID.
    fn pane(&mut self, kind: &str) -> Pane {
        self.panes += 1;
        let id = (0x4000_8000_u128 << 64) | u128::from(self.panes);
        let hex = format!("{id:032x}");
        let parts = [
            &hex[..8],
            &hex[8..12],
            &hex[12..16],
            &hex[16..20],
            &hex[20..],
        ];
        Pane {
            path: format!("{kind}/{}", parts.join("-")),
            id: id.to_be_bytes(),
        }
    }

    fn log(&mut self, entity: &str, parts: &dyn AsComponents) -> RecordingStreamResult<()> {
        let time = TimeColumn::new_sequence(TIMELINE, [0]);
        let columns = parts.as_serialized_batches().into_iter();
        self.rec
            .send_columns(entity, Some(time), columns.map(Into::into))
    }
}
